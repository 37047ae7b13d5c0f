// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "core/motion.hpp"
#include "core/result.hpp"
#include "core/show.hpp"
#include "planner/motion/crowd.hpp"
#include "planner/progress.hpp"

namespace footlight::planner {

/// Leads a crowd from where it stands to where it shall be. Each model has an overload for its own options; an error is
/// about what the user wrote, without a position; interrupted when told to stop.
/// @return positions at every instant of the task, the first those of `task.from`; nobody's way meets anything blocked
/// @{
[[nodiscard]] Result<Trajectory> move_crowd(const MotionTask& task, std::monostate, const Progress& progress);
[[nodiscard]] Result<Trajectory> move_crowd(const MotionTask& task, const SrdOptions& options,
                                            const Progress& progress);
[[nodiscard]] Result<Trajectory> move_crowd(const MotionTask& task, const SwarmOptions& options,
                                            const Progress& progress);
[[nodiscard]] Result<Trajectory> move_crowd(const MotionTask& task, const CollectiveOptions& options,
                                            const Progress& progress);
[[nodiscard]] Result<Trajectory> move_crowd(const MotionTask& task, const PaintedOptions& options,
                                            const Progress& progress);
/// @}

/// By the model that the options are of.
[[nodiscard]] Result<Trajectory> move_crowd(const MotionTask& task, const MotionOptions& options,
                                            const Progress& progress);

}  // namespace footlight::planner
