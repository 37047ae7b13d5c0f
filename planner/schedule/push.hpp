// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "planner/schedule/steps.hpp"

namespace footlight::planner {

/// Goes on with a schedule that has come to a halt because people of different kinds, who may not exchange goals, block
/// each other: whoever waited longest steps first, asks whoever stands on the cell she wants to step aside, also from a
/// goal, and takes the next best cell where they cannot. Ends when all are at their goals, after `task.most_steps` in
/// all or after a bounded number of its own steps: everybody gets to her goal some time, which is not to say that all
/// are there at once. O(steps x people x neighbours), and O(cells) for each goal that is searched.
/// Source: PIBT, Okumura, Machida, Defago, Tamura 2022, "Priority Inheritance with Backtracking for Iterative
/// Multi-agent Path Finding", Algorithm 1; within a kind goals are exchanged first as in `step_through`.
/// @param steps of `step_through(task)`; in: not arrived
void push_aside(const StepsTask& task, Steps& steps);

/// Cosine of the sharpest turn by which somebody may come to a cell behind whoever leaves it in the same step.
[[nodiscard]] double least_turn(const StepsTask& task);

}  // namespace footlight::planner
