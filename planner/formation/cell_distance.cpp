// SPDX-License-Identifier: Apache-2.0
#include "planner/formation/cell_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace footlight::planner {

CellDistance::CellDistance(const Grid& grid) : grid_(grid), lines_(lines_of(grid)) {
  const auto size = static_cast<std::size_t>(grid.size());
  line_of_.resize(size);
  for (std::size_t n = 0; n < lines_.size(); ++n) {
    for (int k = 0; k < lines_[n].count; ++k) line_of_[lines_[n].cell(k).at()] = n;
  }
  taken_.resize(size);
  before_.resize(size);
  after_.resize(size);
  line_taken_.resize(lines_.size());
}

void CellDistance::set_to(std::span<const CellIndex> cells) {
  std::fill(taken_.begin(), taken_.end(), char{0});
  std::fill(line_taken_.begin(), line_taken_.end(), char{0});
  for (const CellIndex cell : cells) {
    taken_[cell.at()] = 1;
    line_taken_[line_of_[cell.at()]] = 1;
  }
  for (std::size_t n = 0; n < lines_.size(); ++n) {
    if (line_taken_[n] == 0) continue;
    const GridLine& line = lines_[n];
    int near = -1;
    for (int k = 0; k < line.count; ++k) {
      const std::size_t cell = line.cell(k).at();
      if (taken_[cell] != 0) near = k;
      before_[cell] = near;
    }
    near = -1;
    for (int k = line.count - 1; k >= 0; --k) {
      const std::size_t cell = line.cell(k).at();
      if (taken_[cell] != 0) near = k;
      after_[cell] = near;
    }
  }
}

double CellDistance::of(CellIndex cell) const {
  const Point here = grid_.centre(cell);
  double best_m2 = std::numeric_limits<double>::infinity();
  const auto look = [&](std::size_t n) {
    const GridLine& line = lines_[n];
    const double up_m = line.y_m - here.y;
    if (up_m * up_m >= best_m2) return false;
    if (line_taken_[n] == 0) return true;
    const int left = std::clamp(static_cast<int>(std::floor((here.x - line.x_m) / line.step_m)), 0, line.count - 1);
    const int right = std::min(left + 1, line.count - 1);
    for (const int k : {before_[line.cell(left).at()], after_[line.cell(left).at()], after_[line.cell(right).at()]}) {
      if (k >= 0) best_m2 = std::min(best_m2, squared_length(grid_.centre(line.cell(k)) - here));
    }
    return true;
  };
  const std::size_t own = line_of_[cell.at()];
  for (std::size_t n = own; n < lines_.size() && look(n); ++n) {
  }
  for (std::size_t n = own; n > 0 && look(n - 1); --n) {
  }
  return std::sqrt(best_m2);
}

}  // namespace footlight::planner
