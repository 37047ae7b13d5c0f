// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "core/plan.hpp"
#include "core/show.hpp"
#include "planner/motion/crowd.hpp"
#include "planner/schedule/ways.hpp"

namespace footlight::bench {

/// What the planner asked the model of a section, once more, and what it points to; to see what people would do if they
/// were not on cells.
struct RawTask {
  RawTask(const Show& show, const Section& section);
  RawTask(const RawTask&) = delete;
  RawTask& operator=(const RawTask&) = delete;

  planner::Ways ways;
  planner::MotionFloor floor;
  planner::MotionTask task;
  std::vector<std::size_t> performer;  ///< who each person of the task is
};

/// People and places are in the order of where they are (planner/motion/ordered_task.hpp), so that a model that is
/// asked directly does what it did for the plan.
/// @param section with a model of motion  @param every_s instants that are seen; the section's end is the last
[[nodiscard]] std::unique_ptr<const RawTask> raw_task(const Show& show, const Plan& plan, const Section& section,
                                                      double every_s);

/// Where everybody of the task walks at each of its instants.
[[nodiscard]] std::vector<std::vector<Point>> walked_ways(const Show& show, const Plan& plan, const Section& section,
                                                          const RawTask& raw);

}  // namespace footlight::bench
