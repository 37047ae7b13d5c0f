// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/motion/collective_options.hpp"
#include "core/result.hpp"
#include "planner/collective/crossing.hpp"
#include "planner/collective/timed_ways.hpp"
#include "planner/motion/crowd.hpp"
#include "planner/progress.hpp"

namespace footlight::planner::collective {

/// All that is decided before anybody moves: Xu 2015, sections 3.2 and 3.4.
struct Preparation {
  std::vector<std::uint32_t> place_of;  ///< of each person, an index of task.to
  double cost = 0;                      ///< Eq. 6 over all groups
  TimedWays ways;
  std::vector<std::uint32_t> subgroup;  ///< of each person, 0..; empty: switched off
  std::size_t subgroups = 0;
  std::vector<Crossing> crossings;
  std::vector<std::string> notes;
};

/// @return ErrorKind::input when somebody cannot get to any place of her group, or a group has not as many places as
/// people; interrupted when stopped. O(people^2) and the pairing. Thread: reentrant, parallel inside, deterministic.
[[nodiscard]] Result<Preparation> prepare(const MotionTask& task, const CollectiveOptions& options,
                                          const Progress& progress);

}  // namespace footlight::planner::collective
