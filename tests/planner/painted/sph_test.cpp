// SPDX-License-Identifier: Apache-2.0
#include "planner/painted/sph.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace footlight::planner {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(Particles, KernelsHaveTheirValues) {
  // h = 2: 4 / (256 pi) (4 - r^2)^3 at r = 0 and r = 1.
  EXPECT_NEAR(poly6(0, 2), 1 / kPi, 1e-12);
  EXPECT_NEAR(poly6(1, 2), 27.0 / (64 * kPi), 1e-12);
  EXPECT_EQ(poly6(4, 2), 0);
  // -30 / (32 pi) (2 - 1)^2
  EXPECT_NEAR(spiky_slope(1, 2), -30 / (32 * kPi), 1e-12);
  EXPECT_EQ(spiky_slope(2, 2), 0);
  // 40 / (32 pi) (2 - 1)
  EXPECT_NEAR(viscosity_laplacian(1, 2), 1.25 / kPi, 1e-12);
  EXPECT_EQ(viscosity_laplacian(2.5, 2), 0);
}

TEST(Particles, KernelsAreWholeOverThePlane) {
  const double h = 1.7;
  const int rings = 20'000;
  double mass = 0;
  double slope = 0;
  double bend = 0;
  for (int i = 0; i < rings; ++i) {
    const double r = (i + 0.5) * h / rings;
    const double ring = 2 * kPi * r * h / rings;
    mass += poly6(r * r, h) * ring;
    // By parts: the integral of W is -1/2 that of r W', and 1/4 that of r^2 times its Laplacian.
    slope += -0.5 * r * spiky_slope(r, h) * ring;
    bend += 0.25 * r * r * viscosity_laplacian(r, h) * ring;
  }
  EXPECT_NEAR(mass, 1, 1e-6);
  EXPECT_NEAR(slope, 1, 1e-6);
  EXPECT_NEAR(bend, 1, 1e-6);
}

/// People whose kernels reach 2 m when they are alike.
struct Crowd {
  std::vector<Point> at;
  std::vector<Point> velocity = std::vector<Point>(at.size());
  std::vector<double> spacing_m = std::vector<double>(at.size(), 1.0);

  [[nodiscard]] Particles people() const {
    return {at, velocity, spacing_m, *std::max_element(spacing_m.begin(), spacing_m.end())};
  }
  [[nodiscard]] Neighbours near() const {
    Neighbours out;
    out.sort(at, 2);
    return out;
  }
  [[nodiscard]] std::vector<double> taken() const { return floor_taken(people(), near()); }
  [[nodiscard]] std::vector<Point> accelerations(const ParticleFluid& fluid) const {
    std::vector<Point> out;
    const std::vector<double> floor = taken();
    for (std::size_t i = 0; i < at.size(); ++i) {
      out.push_back(particle_acceleration(fluid, people(), floor, near(), i));
    }
    return out;
  }
};

TEST(Particles, TwoPeoplePressEachOtherApartByHand) {
  const Crowd two{{{0, 0}, {1, 0}}};
  // Area sqrt(3)/2 each, times W(0) + W(1) = 91 / (64 pi).
  const double area = std::sqrt(3.0) / 2;
  const double taken = area * 91 / (64 * kPi);
  EXPECT_NEAR(two.taken()[0], taken, 1e-12);
  const auto a = two.accelerations({3, 0, 0.1});
  const double pressure = 3 * (taken - 0.1);
  const double expected = area * pressure / taken * (30 / (32 * kPi)) / taken;
  EXPECT_NEAR(a[0].x, -expected, 1e-12);
  EXPECT_NEAR(a[1].x, expected, 1e-12);
  EXPECT_EQ(a[0].y, 0);
}

TEST(Particles, ATriangularLatticeOfTheirSpacingTakesTheWholeFloor) {
  for (const double spacing : {0.6, 1.3}) {
    Crowd lattice;
    for (int row = -6; row <= 6; ++row) {
      for (int n = -6; n <= 6; ++n) {
        lattice.at.push_back({spacing * (n + 0.5 * (row % 2)), spacing * row * std::sqrt(3.0) / 2});
      }
    }
    lattice.velocity.resize(lattice.at.size());
    lattice.spacing_m.assign(lattice.at.size(), spacing);
    EXPECT_NEAR(lattice.taken()[6 * 13 + 6], 0.9992, 1e-4);
    const auto a = lattice.accelerations({3, 0.5, 1});
    EXPECT_EQ(a[6 * 13 + 6], (Point{}));
  }
}

TEST(Particles, WhoIsWideIsFeltFromFarther) {
  Crowd two{{{0, 0}, {2.5, 0}}};
  EXPECT_EQ(two.accelerations({3, 0, 0})[0], (Point{}));
  two.spacing_m[1] = 2;
  // Kernels of 3 m between the two, of 2 and of 4 m for each alone.
  const double between = poly6(6.25, 3);
  EXPECT_NEAR(two.taken()[0], std::sqrt(3.0) / 2 * (poly6(0, 2) + 4 * between), 1e-12);
  EXPECT_NEAR(two.taken()[1], std::sqrt(3.0) / 2 * (4 * poly6(0, 4) + between), 1e-12);
  EXPECT_LT(two.accelerations({3, 0, 0})[0].x, 0);
}

TEST(Particles, BelowRestNobodyIsPulled) {
  const Crowd two{{{0, 0}, {1, 0}}};
  const auto a = two.accelerations({3, 0, 1});
  EXPECT_EQ(a[0], (Point{}));
  EXPECT_EQ(a[1], (Point{}));
}

TEST(Particles, ViscosityTakesOnTheNeighboursVelocity) {
  Crowd two{{{0, 0}, {1, 0}}};
  two.velocity[1] = {0, 2};
  const auto a = two.accelerations({3, 0.5, 5});
  const double taken = 91.0 / (64 * kPi);
  EXPECT_NEAR(a[0].y, 0.5 * 2 * (1.25 / kPi) / taken, 1e-12);
  EXPECT_NEAR(a[1].y, -a[0].y, 1e-12);
}

TEST(Particles, TwoAtOnePointPart) {
  const Crowd two{{{1, 1}, {1, 1}}};
  const auto a = two.accelerations({3, 0, 0.1});
  EXPECT_GT(a[0].x, 0);
  EXPECT_LT(a[1].x, 0);
}

}  // namespace
}  // namespace footlight::planner
