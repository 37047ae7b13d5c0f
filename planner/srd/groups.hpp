// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/motion/srd_options.hpp"
#include "core/result.hpp"
#include "planner/motion/crowd.hpp"
#include "planner/srd/free_floor.hpp"
#include "planner/srd/march.hpp"

namespace footlight::planner::srd {

/// The groups of a crowd (Eq. 1), each with its march, and everybody's place in her group's formations.
struct Groups {
  std::vector<std::int32_t> of;  ///< of each person, into `march`
  std::vector<Offsets> offsets;  ///< of each person, from the centre of her group
  std::vector<March> march;
  std::vector<std::uint32_t> place_of;  ///< as Trajectory
};

/// Divides a crowd: people of one group of the show are one group, who is in none are another. A group's way leads from
/// where it stands (Eq. 2) over the points of its path, in their order, to the middle of its places, around what is
/// blocked; without a path straight there. Without places the formation of the beginning is carried to the last point.
///
/// Who gets which place is the exact assignment of the least sum of squares of the two formations laid upon each other,
/// within each group, so that a formation that is kept is not mixed; where places are nobody's, the one of the whole
/// crowd, everybody moved with her group's path first.
/// @return ErrorKind::input: places or points of a path that cannot be walked to, a group with more or fewer places
/// than people, a way that takes too long. O(people log people) and the assignment
[[nodiscard]] Result<Groups> divide(const MotionTask& task, const SrdOptions& options, const FreeFloor& floor);

}  // namespace footlight::planner::srd
