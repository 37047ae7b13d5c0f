// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/grid.hpp"
#include "planner/motion/neighbours.hpp"

namespace footlight::planner {

// Kernels of Mueller, Charypar, Gross, "Particle-Based Fluid Simulation for Interactive Applications", SCA 2003, Eq.
// 20-22, for a floor instead of space: the same shapes, normalised over the plane. 0 from r = h on.

/// (4 / (pi h^8)) (h^2 - r^2)^3, 1/m^2  @param squared_m2 r^2
[[nodiscard]] double poly6(double squared_m2, double h_m);
/// Derivative by r of (10 / (pi h^5)) (h - r)^3: -(30 / (pi h^5)) (h - r)^2, 1/m^3
[[nodiscard]] double spiky_slope(double r_m, double h_m);
/// Laplacian of the viscosity kernel: (40 / (pi h^5)) (h - r), 1/m^4
[[nodiscard]] double viscosity_laplacian(double r_m, double h_m);

struct ParticleFluid {
  double reach_m = 1;           ///< h
  double rest_per_m2 = 1;       ///< people on a square metre who do not press each other
  double stiffness = 1;         ///< m^4/s^2: pressure of one person a square metre too many, over a person's mass
  double viscosity_m2ps = 0.5;  ///< how fast neighbours take on each other's velocity
};

/// What people do to each other as particles of a fluid.
///
/// Source: Mueller et al. 2003, Eq. 3 (density), 10 and 12 (pressure, symmetric), 14 (viscosity); everybody has mass 1.
/// Pressure is never negative: people press, they do not pull.
/// @return acceleration of each person, m/s^2. Sums run in the order of `near`, in parallel over people with the same
/// bytes for any number of threads. O(people x neighbours)
[[nodiscard]] std::vector<Point> particle_accelerations(const ParticleFluid& fluid, const Neighbours& near,
                                                        std::span<const Point> position,
                                                        std::span<const Point> velocity);

/// Eq. 3: people per square metre around each one, oneself included.
[[nodiscard]] std::vector<double> particle_densities(double reach_m, const Neighbours& near,
                                                     std::span<const Point> position);

}  // namespace footlight::planner
