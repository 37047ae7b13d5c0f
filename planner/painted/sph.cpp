// SPDX-License-Identifier: Apache-2.0
#include "planner/painted/sph.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "planner/painted/in_chunks.hpp"

namespace footlight::planner {
namespace {

constexpr double kPi = std::numbers::pi;

}  // namespace

double poly6(double squared_m2, double h_m) {
  const double left = h_m * h_m - squared_m2;
  return left <= 0 ? 0 : 4 / (kPi * std::pow(h_m, 8)) * left * left * left;
}

double spiky_slope(double r_m, double h_m) {
  const double left = h_m - r_m;
  return left <= 0 ? 0 : -30 / (kPi * std::pow(h_m, 5)) * left * left;
}

double viscosity_laplacian(double r_m, double h_m) {
  const double left = h_m - r_m;
  return left <= 0 ? 0 : 40 / (kPi * std::pow(h_m, 5)) * left;
}

std::vector<double> particle_densities(double reach_m, const Neighbours& near, std::span<const Point> position) {
  std::vector<double> out(position.size(), 0);
  in_chunks(position.size(), [&](std::size_t i) {
    double sum = 0;
    near.visit(position[i], reach_m, [&](std::uint32_t, double squared) { sum += poly6(squared, reach_m); });
    out[i] = sum;
  });
  return out;
}

std::vector<Point> particle_accelerations(const ParticleFluid& fluid, const Neighbours& near,
                                          std::span<const Point> position, std::span<const Point> velocity) {
  const double h = fluid.reach_m;
  const std::vector<double> density = particle_densities(h, near, position);
  const auto pressure = [&](std::size_t i) { return fluid.stiffness * std::max(0.0, density[i] - fluid.rest_per_m2); };
  std::vector<Point> out(position.size());
  in_chunks(position.size(), [&](std::size_t i) {
    Point press;
    Point drag;
    near.visit(position[i], h, [&](std::uint32_t k, double squared) {
      if (k == i) return;
      const double r = std::sqrt(squared);
      // Two at one point have no direction to part in; the lower number goes to the right.
      const Point along = r > 0 ? 1 / r * (position[i] - position[k]) : Point{i < k ? 1.0 : -1.0, 0};
      press = press - (pressure(i) + pressure(k)) / (2 * density[k]) * spiky_slope(r, h) * along;
      drag = drag + 1 / density[k] * viscosity_laplacian(r, h) * (velocity[k] - velocity[i]);
    });
    out[i] = 1 / density[i] * press + fluid.viscosity_m2ps * drag;
  });
  return out;
}

}  // namespace footlight::planner
