// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "core/grid.hpp"

/// The equations of Y.-Y. Lin, "Crowd Control with Swarm Intelligence", 2007, one function each; on the floor there are
/// two axes, and a scope is the same along both.
namespace footlight::planner::swarm {

/// w, c1 and c2 with this step's random numbers r1, r2 in [0, 1).
struct Pull {
  double inertia = 1;
  double cognitive = 0;  ///< c1 r1
  double social = 0;     ///< c2 r2
};

/// V(t+1) = w V(t) + c1 r1 (P_BLS - P(t)) + c2 r2 (P_BGS - P(t))                                              (2)
/// @param velocity m an iteration, as P(t+1) = P(t) + V(t+1) (3) takes it
[[nodiscard]] inline Point next_velocity(Point velocity, Point at, Point best, Point group_best, const Pull& pull) {
  return pull.inertia * velocity + pull.cognitive * (best - at) + pull.social * (group_best - at);
}

/// `v` with length 1; nothing of nothing.
[[nodiscard]] inline Point unit(Point v) {
  const double square = squared_length(v);
  return square > 0 ? 1 / std::sqrt(square) * v : Point{};
}

/// D(t+1) = w D(t) + c1 r1 (P_BLS - P(t)) + c2 r2 (P_BGS - P(t)), both brackets as unit vectors                (6)
/// The thesis keeps the speed apart (Eq. 7), so what comes out is made a unit vector again. Two pulls that cancel leave
/// the direction as it was.
[[nodiscard]] inline Point next_direction(Point direction, Point at, Point best, Point group_best, const Pull& pull) {
  const Point sum = pull.inertia * direction + pull.cognitive * unit(best - at) + pull.social * unit(group_best - at);
  return squared_length(sum) > 0 ? unit(sum) : direction;
}

/// Cost(P, Q) = exp(-|P - Q|^2 / (sigma_P + sigma_Q)^2)                                                        (8)
/// @param squared |P - Q|^2 / (sigma_P + sigma_Q)^2
[[nodiscard]] inline double object_cost(double squared) { return std::exp(-squared); }

/// F(P) = c_obj max_o Cost(P, o) + 1 / Cost(P, G)                                                              (9)
/// @param weighed c_obj times the largest cost  @param target_squared |P - G|^2 / (scope of the whole floor)^2
[[nodiscard]] inline double objective(double weighed, double target_squared) {
  return weighed + std::exp(target_squared);
}

/// prob(f) = 1 - f / e^-k, never below 0                                                                      (10)
[[nodiscard]] inline double acceptance(double cost, double hardness) {
  return std::max(0.0, 1 - cost * std::exp(hardness));
}

/// P(t+1) = P(t) + D(t+1) S(t+1): the speed S for Eq. 7, as share of V_max. The thesis gives no formula for "slower
/// near an obstacle" and "decreases gradually close to the goal": as Eq. 10 accepts, and evenly within `slow_m`.
[[nodiscard]] inline double speed_share(double cost, double hardness, double to_target_m, double slow_m) {
  constexpr double kSlowest = 0.3;  // or who touches somebody could never leave
  return std::max(kSlowest, acceptance(cost, hardness)) * std::min(1.0, to_target_m / slow_m);
}

}  // namespace footlight::planner::swarm
