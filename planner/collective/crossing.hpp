// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "planner/collective/timed_ways.hpp"
#include "planner/motion/crowd.hpp"

namespace footlight::planner::collective {

/// Two groups whose ways meet.
struct Crossing {
  std::uint32_t first = 0;  ///< groups
  std::uint32_t second = 0;
  double from_s = 0;  ///< they are in each other
  double until_s = 0;
  Point aside;          ///< by which the first group goes aside, the second by as much the other way
  double before_m = 0;  ///< least distance of two people of them, if all kept to their ways
  double after_m = 0;   ///< with both gone aside
};

/// Where to be so that the files of two rigid formations pass between each other: the shift s in [-most_m, most_m] for
/// which the least |a - b + s| of all pairs is largest; the shortest such shift. O((n + m) log (n + m) + n m) of
/// numbers within reach of each other.
[[nodiscard]] double widest_shift(std::span<const double> first, std::span<const double> second, double most_m);

/// Finds who meets whom by the ideal ways, and lets both go aside for as long as it lasts, at right angles to how they
/// pass, so that each keeps its shape. The paper leaves this open (section 6). Groups of fewer than two people meet
/// nobody.
/// @param group of each person  @param radius_m half of everybody's room  @param speed_mps least of all limits
[[nodiscard]] std::vector<Crossing> pass_between(const MotionTask& task, TimedWays& ways);

}  // namespace footlight::planner::collective
