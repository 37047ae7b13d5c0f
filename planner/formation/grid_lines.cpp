// SPDX-License-Identifier: Apache-2.0
#include "planner/formation/grid_lines.hpp"

#include <algorithm>

namespace footlight::planner {

std::vector<GridLine> lines_of(const Grid& grid) {
  const int in_row = grid.kind() == GridKind::triangular ? 2 : 1;
  std::vector<GridLine> lines;
  for (int row = 0; row < grid.rows(); ++row) {
    for (int column = 0; column < std::min(in_row, grid.columns()); ++column) {
      const Point at = grid.centre(Cell{column, row});
      // Also where there is one cell only.
      const double step_m = grid.centre(Cell{column + in_row, row}).x - at.x;
      lines.push_back(
          {at.y, at.x, step_m, row * grid.columns() + column, in_row, (grid.columns() - column + in_row - 1) / in_row});
    }
  }
  std::sort(lines.begin(), lines.end(), [](const GridLine& a, const GridLine& b) { return a.y_m < b.y_m; });
  return lines;
}

}  // namespace footlight::planner
