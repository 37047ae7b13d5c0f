// SPDX-License-Identifier: Apache-2.0
#include "planner/motion/models.hpp"

#include <variant>

namespace footlight::planner {

Result<Trajectory> move_crowd(const MotionTask&, std::monostate, const Progress&) {
  return internal_error("a section without a model of motion was to be moved");
}

Result<Trajectory> move_crowd(const MotionTask& task, const MotionOptions& options, const Progress& progress) {
  return std::visit([&](const auto& own) { return move_crowd(task, own, progress); }, options);
}

}  // namespace footlight::planner
