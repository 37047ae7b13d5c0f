// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/film.hpp"
#include "core/grid.hpp"

namespace footlight::config {

/// Cells into which the polygon reaches by more than a hundredth of a millimetre, ascending: over their outline, not
/// only along it. Corners in order, either way round; it may be concave, and what it encloses an odd number of times is
/// inside. O(cells in its box x corners)
[[nodiscard]] std::vector<CellIndex> cells_of_polygon(const Grid& grid, const std::vector<Point>& corners);

/// Cells into which a pixel of the map reaches, ascending; the map covers the floor from edge to edge, row 0 upstage.
/// O(pixels of the map)
[[nodiscard]] std::vector<CellIndex> cells_of_map(const Grid& grid, const Mask& map);

}  // namespace footlight::config
