// SPDX-License-Identifier: Apache-2.0
#include "planner/painted/sph.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "planner/painted/in_chunks.hpp"

namespace footlight::planner {
namespace {

constexpr double kPi = std::numbers::pi;

/// Of a person in a triangular lattice.
double area_m2(double spacing_m) { return std::numbers::sqrt3 / 2 * spacing_m * spacing_m; }

double fifth_power(double h) { return h * h * h * h * h; }

}  // namespace

double poly6(double squared_m2, double h_m) {
  const double whole = h_m * h_m;
  const double left = whole - squared_m2;
  return left <= 0 ? 0 : 4 / kPi * left * left * left / (whole * whole * whole * whole);
}

double spiky_slope(double r_m, double h_m) {
  const double left = h_m - r_m;
  return left <= 0 ? 0 : -30 / kPi * left * left / fifth_power(h_m);
}

double viscosity_laplacian(double r_m, double h_m) {
  const double left = h_m - r_m;
  return left <= 0 ? 0 : 40 / kPi * left / fifth_power(h_m);
}

std::vector<double> floor_taken(const Particles& people, const Neighbours& near) {
  std::vector<double> out(people.position.size(), 0);
  in_chunks(out.size(), [&](std::size_t i) {
    const double own = people.spacing_m[i];
    double sum = 0;
    near.visit(people.position[i], own + people.widest_m, [&](std::uint32_t k, double squared) {
      const double other = people.spacing_m[k];
      sum += area_m2(other) * poly6(squared, own + other);
    });
    out[i] = sum;
  });
  return out;
}

Point particle_acceleration(const ParticleFluid& fluid, const Particles& people, std::span<const double> taken,
                            const Neighbours& near, std::size_t person) {
  const auto pressure = [&](std::size_t i) { return fluid.stiffness_m2ps2 * std::max(0.0, taken[i] - fluid.rest); };
  const Point at = people.position[person];
  const double own = people.spacing_m[person];
  const double pressed = pressure(person);
  Point press;
  Point drag;
  near.visit(at, own + people.widest_m, [&](std::uint32_t k, double squared) {
    if (k == person) return;
    const double h = own + people.spacing_m[k];
    if (squared >= h * h) return;
    const double r = std::sqrt(squared);
    // Two at one point have no direction to part in; the lower number goes to the right.
    const Point along = r > 0 ? 1 / r * (at - people.position[k]) : Point{person < k ? 1.0 : -1.0, 0};
    const double share = area_m2(people.spacing_m[k]) / taken[k];
    press = press - share * (pressed + pressure(k)) / 2 * spiky_slope(r, h) * along;
    drag = drag + share * viscosity_laplacian(r, h) * (people.velocity[k] - people.velocity[person]);
  });
  return 1 / taken[person] * press + fluid.viscosity_m2ps * drag;
}

}  // namespace footlight::planner
