// SPDX-License-Identifier: Apache-2.0
#include "planner/formation/summed_area.hpp"

#include <algorithm>
#include <cmath>

namespace footlight::planner {

SummedArea::SummedArea(const Mask& mask) : width_(mask.width()), height_(mask.height()) {
  const std::size_t stride = static_cast<std::size_t>(width_) + 1;
  sums_.assign(stride * (static_cast<std::size_t>(height_) + 1), 0);
  const std::size_t row_words = static_cast<std::size_t>(mask.row_words());
  for (std::size_t y = 0; y < static_cast<std::size_t>(height_); ++y) {
    std::uint32_t row = 0;
    for (std::size_t x = 0; x + 1 < stride; ++x) {
      row += static_cast<std::uint32_t>((mask.words()[y * row_words + x / 64] >> (x % 64)) & 1U);
      sums_[(y + 1) * stride + x + 1] = sums_[y * stride + x + 1] + row;
    }
  }
}

double SummedArea::corner(double x, double y) const {
  if (width_ == 0 || height_ == 0) return 0;
  x = std::clamp(x, 0.0, static_cast<double>(width_));
  y = std::clamp(y, 0.0, static_cast<double>(height_));
  const int i = std::min(static_cast<int>(x), width_ - 1);
  const int j = std::min(static_cast<int>(y), height_ - 1);
  const double fx = x - i;
  const double fy = y - j;
  const std::size_t stride = static_cast<std::size_t>(width_) + 1;
  const std::size_t at = static_cast<std::size_t>(j) * stride + static_cast<std::size_t>(i);
  return sums_[at] * (1 - fx) * (1 - fy) + sums_[at + 1] * fx * (1 - fy) + sums_[at + stride] * (1 - fx) * fy +
         sums_[at + stride + 1] * fx * fy;
}

double SummedArea::area(double x0, double y0, double x1, double y1) const {
  return corner(x1, y1) - corner(x0, y1) - corner(x1, y0) + corner(x0, y0);
}

std::vector<double> cell_shares(const SummedArea& picture, const Grid& grid, const StageToFrame& map) {
  const double scale = std::sqrt(std::abs(map[0] * map[4] - map[1] * map[3]));
  const double side = std::sqrt(grid.cell_area_m2()) * scale;
  std::vector<double> shares(static_cast<std::size_t>(grid.size()));
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const Point centre = grid.centre(CellIndex::of(i));
    const double x = map[0] * centre.x + map[1] * centre.y + map[2];
    const double y = map[3] * centre.x + map[4] * centre.y + map[5];
    const double area = picture.area(x - side / 2, y - side / 2, x + side / 2, y + side / 2);
    // Six digits: what is equal but for the last bits must compare equal, and noise is no picture.
    shares[i] = std::clamp(std::round(area / (side * side) * 1e6) / 1e6, 0.0, 1.0);
  }
  return shares;
}

}  // namespace footlight::planner
