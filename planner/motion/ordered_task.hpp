// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "planner/motion/crowd.hpp"

namespace footlight::planner {

/// A task with people and places in the order of where they are: x, then y. A model that is asked this instead of the
/// task as it came gives the same bytes however people and places were numbered: streams of chance follow people, and
/// equals are told apart by where they stand. O(people log people)
class OrderedTask {
 public:
  /// People who stand on one point keep the order that they came in; plans have none.
  explicit OrderedTask(const MotionTask& given);

  [[nodiscard]] const MotionTask& task() const { return task_; }
  /// What a model made of `task()`, with people and places as they came.
  [[nodiscard]] Trajectory as_given(const Trajectory& led) const;

 private:
  MotionTask task_;
  std::vector<std::uint32_t> who_;    ///< of each person of `task_`, her number as it came
  std::vector<std::uint32_t> where_;  ///< of each place
};

}  // namespace footlight::planner
