// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/grid.hpp"
#include "planner/formation/grid_lines.hpp"

namespace footlight::planner {

/// How far cells are from the nearest of some cells, exactly. Each line of the grid knows for each of its cells the
/// next of them on both sides; a cell looks at the lines around its own until they are too far away.
class CellDistance {
 public:
  explicit CellDistance(const Grid& grid);

  /// O(cells)
  void set_to(std::span<const CellIndex> cells);
  /// m; infinity when there are none. O(lines that are not too far away)
  [[nodiscard]] double of(CellIndex cell) const;

 private:
  const Grid& grid_;
  std::vector<GridLine> lines_;
  std::vector<std::size_t> line_of_;  ///< one a cell
  std::vector<char> taken_;           ///< one flag a cell
  std::vector<char> line_taken_;      ///< anybody on the line
  std::vector<int> before_;           ///< of each cell: position on its line of the last one at or before it, or -1
  std::vector<int> after_;            ///< of the first one at or after it, or -1
};

}  // namespace footlight::planner
