// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/grid.hpp"

namespace footlight::planner {

/// Gives everybody a cell of her own near where she should be: who is nearest to a cell gets it, who loses one asks for
/// the next (Gale, Shapley 1962, stable matching by distance); then the cheapest exchange of squared distances.
/// @param places metres  @param cells at least as many, distinct  @return a cell for each place. O(places x cells)
[[nodiscard]] std::vector<CellIndex> seats_in_shape(const Grid& grid, const std::vector<Point>& places,
                                                    const std::vector<CellIndex>& cells);

}  // namespace footlight::planner
