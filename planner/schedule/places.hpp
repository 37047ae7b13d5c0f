// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/index.hpp"

namespace footlight::planner {

/// A cell that somebody can take, at a cost >= 0.
struct Choice {
  CellIndex cell;
  double cost = 0;
};

/// Gives everybody a cell of her own among her choices at the least total cost; more cells than people are normal.
/// Successive shortest paths with potentials (Jonker, Volgenant 1987, the augmenting part).
/// @param choices for each person; an empty list has no answer  @return nothing when there are too few cells
/// O(people x choices log choices) in practice, since paths stay short
[[nodiscard]] std::optional<std::vector<CellIndex>> cheapest_places(const std::vector<std::vector<Choice>>& choices,
                                                                    std::size_t cells);

}  // namespace footlight::planner
