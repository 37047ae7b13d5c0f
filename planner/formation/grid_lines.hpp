// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/grid.hpp"

namespace footlight::planner {

/// Cells of one row whose centres have the same y, evenly apart: a row of squares or hexagons, every second triangle.
struct GridLine {
  double y_m = 0;
  double x_m = 0;     ///< of the first cell
  double step_m = 0;  ///< from cell to cell, > 0
  int first = 0;      ///< index of the first cell
  int stride = 1;     ///< from a cell's index to the next one's
  int count = 0;      ///< >= 1

  [[nodiscard]] CellIndex cell(int n) const { return CellIndex::of(first + n * stride); }
};

/// All lines of a grid, y ascending; every cell lies on one.
[[nodiscard]] std::vector<GridLine> lines_of(const Grid& grid);

}  // namespace footlight::planner
