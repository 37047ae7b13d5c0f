// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "planner/schedule/ways.hpp"

namespace footlight::planner {

/// Everybody goes from cells to cells, over neighbouring cells, around whatever is blocked; who takes which is free.
struct ShiftTask {
  const Ways* ways = nullptr;
  std::span<const CellIndex> from;  ///< distinct
  std::span<const CellIndex> to;    ///< distinct, as many
  int most_steps = 0;               ///< instants after the first at most
};

/// Where each person is at each step: the first are `from`, the last `to` in another order; those of one step are
/// distinct; from step to step everybody stays or goes to a neighbouring cell. A maximum flow through cells x steps
/// (Dinic 1970, unit capacities; each cell of a step takes one person), tried with few steps first, so that whatever
/// can be done in `most_steps` is found, and mostly soon.
/// @return nothing when nothing can be done in so many steps, or the stage is too large to look. Deterministic.
[[nodiscard]] std::optional<std::vector<std::vector<CellIndex>>> shift(const ShiftTask& task);

}  // namespace footlight::planner
