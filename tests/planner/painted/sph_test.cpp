// SPDX-License-Identifier: Apache-2.0
#include "planner/painted/sph.hpp"

#include <cmath>
#include <numbers>

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

TEST(Particles, TwoPeoplePressEachOtherApartByHand) {
  const std::vector<Point> at{{0, 0}, {1, 0}};
  const std::vector<Point> still{{0, 0}, {0, 0}};
  Neighbours near;
  near.sort(at, 2);
  const double density = poly6(0, 2) + poly6(1, 2);
  const auto densities = particle_densities(2, near, at);
  EXPECT_NEAR(densities[0], density, 1e-12);
  EXPECT_NEAR(densities[0], 91.0 / (64 * kPi), 1e-12);
  const ParticleFluid fluid{2, 0.1, 3, 0};
  const auto a = particle_accelerations(fluid, near, at, still);
  const double pressure = 3 * (density - 0.1);
  const double expected = 2 * pressure / (2 * density) * (30 / (32 * kPi)) / density;
  EXPECT_NEAR(a[0].x, -expected, 1e-12);
  EXPECT_NEAR(a[1].x, expected, 1e-12);
  EXPECT_EQ(a[0].y, 0);
}

TEST(Particles, BelowRestDensityNobodyIsPulled) {
  const std::vector<Point> at{{0, 0}, {1, 0}};
  Neighbours near;
  near.sort(at, 2);
  const auto a = particle_accelerations({2, 5, 3, 0}, near, at, std::vector<Point>(2));
  EXPECT_EQ(a[0], (Point{}));
  EXPECT_EQ(a[1], (Point{}));
}

TEST(Particles, ViscosityTakesOnTheNeighboursVelocity) {
  const std::vector<Point> at{{0, 0}, {1, 0}};
  const std::vector<Point> moving{{0, 0}, {0, 2}};
  Neighbours near;
  near.sort(at, 2);
  const auto a = particle_accelerations({2, 5, 3, 0.5}, near, at, moving);
  const double density = 91.0 / (64 * kPi);
  EXPECT_NEAR(a[0].y, 0.5 * 2 * (1.25 / kPi) / density, 1e-12);
  EXPECT_NEAR(a[1].y, -a[0].y, 1e-12);
}

TEST(Particles, TwoAtOnePointPart) {
  const std::vector<Point> at{{1, 1}, {1, 1}};
  Neighbours near;
  near.sort(at, 2);
  const auto a = particle_accelerations({2, 0.1, 3, 0}, near, at, std::vector<Point>(2));
  EXPECT_GT(a[0].x, 0);
  EXPECT_LT(a[1].x, 0);
}

}  // namespace
}  // namespace footlight::planner
