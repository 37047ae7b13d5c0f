// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/motion/srd_options.hpp"
#include "planner/motion/crowd.hpp"
#include "planner/srd/free_floor.hpp"
#include "planner/srd/groups.hpp"

namespace footlight::planner::srd {

/// Others come through a formation whose neighbours are so many times as far apart as two people may come near; a
/// crowd that is denser, and pushed from behind, closes its own gaps.
inline constexpr double kPassable = 2.4;

/// Opens the ranks of groups while they pass through each other: formations in which neighbours are nearer than
/// kPassable times what two people need are spread about their centres until they are not, at most kWidest times, and
/// closed again behind the meeting. Groups that meet nobody, and those that are loose enough, are left alone; so is a
/// march that could not be walked in time when spread. Where there is no room on the floor ranks are opened less.
/// @param marches of each group, as `out.march` was planned from  O(people x (duration + frames))
void open_ranks(std::vector<March::Task>& marches, const SrdOptions& options, const FreeFloor& floor,
                const MotionTask& task, Groups& out);

/// Distance of each point to the nearest other one, at most `most_m`. O(people)
[[nodiscard]] std::vector<double> nearest_others(const std::vector<Point>& at, double most_m);

}  // namespace footlight::planner::srd
