// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "planner/motion/lanes.hpp"
#include "planner/swarm/surroundings.hpp"

namespace footlight::planner::swarm {

/// Some steps that somebody might make from where she stands, judged at once: what each person near means for all of
/// them is one computation.
struct Tries {
  using Lanes = std::array<double, lanes::kLanes>;

  std::size_t size = 0;
  Lanes x{}, y{};   ///< each step, m; nothing beyond `size`
  Lanes squared{};  ///< |P - Q|^2 / sigma^2 of the nearest object Q, where the step ends
  Lanes room{};     ///< least over all near of the swept squared distance less what it must be, m^2; >= 0: free of them
  Lanes worst{};    ///< cost of the nearest object, the ground included
  Lanes weighed{};  ///< the same, by c_obj
  Lanes value{};    ///< Eq. 9
  Lanes ground{};   ///< cost of the ground
  Lanes disc_m{};   ///< how far it stays off everything that moves, beyond what it has to; negative: too near
  std::array<bool, lanes::kLanes> allowed{};  ///< touches nobody, and nothing that stands

  void add(Point step) {
    x[size] = step.x;
    y[size] = step.y;
    ++size;
  }
  [[nodiscard]] Point step(std::size_t i) const { return {x[i], y[i]}; }
  [[nodiscard]] bool free(std::size_t i) const { return allowed[i] && disc_m[i] >= 0; }
};

/// Sets `squared`, no more than it is, and `room`, by everybody near. O(near)
void sweep(std::span<const Surroundings::Near> near, Tries& tries);

/// What Eq. 9 needs beside the objects.
struct Aim {
  Point way;                    ///< from where she stands straight to where her way leads
  double rest_m = 0;            ///< of the way from there
  double avoid = 0;             ///< c_obj of objects
  double avoid_ground = 0;      ///< c_obj of the ground
  double per_floor_square = 1;  ///< of the target's scope, 1/m^2
};
/// Sets `worst`, `weighed` and `value` by `squared` and `ground`.
void weigh(const Aim& aim, Tries& tries);

/// Steps turned by angles in [-pi, pi], as many as there are. At most kLanes.
void add_turned(Point step, std::span<const double> angle_rad, Tries& tries);

}  // namespace footlight::planner::swarm
