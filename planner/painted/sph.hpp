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

/// People as particles. All lists of one length.
struct Particles {
  std::span<const Point> position;
  std::span<const Point> velocity;
  std::span<const double> spacing_m;  ///< how far from the next one each person is at rest, > 0
  double widest_m = 1;                ///< the largest of them
};

struct ParticleFluid {
  double stiffness_m2ps2 = 1;   ///< pressure of twice the rest over it
  double viscosity_m2ps = 0.5;  ///< how fast neighbours take on each other's velocity
  double rest = 1;              ///< share of the floor that is taken where nobody presses
};

/// Eq. 3 of Mueller et al. 2003: share of the floor around each person that is taken, her own included. In place of a
/// mass stands the area that somebody takes in a triangular lattice of her own spacing; two people feel each other
/// within the sum of their spacings. In such a lattice it is 1 (0.9992, as the kernel samples it).
/// O(people x neighbours)
[[nodiscard]] std::vector<double> floor_taken(const Particles& people, const Neighbours& near);

/// What the others do to a person as particles of a fluid: Mueller et al. 2003, Eq. 10 and 12 (pressure, symmetric) and
/// 14 (viscosity). Pressure is never negative: people press, they do not pull.
/// @param taken as `floor_taken` gives it  @return m/s^2. The sum runs in the order of `near`. O(neighbours)
[[nodiscard]] Point particle_acceleration(const ParticleFluid& fluid, const Particles& people,
                                          std::span<const double> taken, const Neighbours& near, std::size_t person);

}  // namespace footlight::planner
