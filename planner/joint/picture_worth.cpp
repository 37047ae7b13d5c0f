// SPDX-License-Identifier: Apache-2.0
#include "planner/joint/picture_worth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "planner/formation/summed_area.hpp"

namespace footlight::planner {

FrameWeight frame_weight(double people, double covered, double area) {
  const double n = std::max(people, 1.0);
  const double either = std::max(area + n - covered, 1.0);
  return {1 / n + (area + n) / (either * either), covered / (n * n) + covered / (either * either)};
}

PictureField::PictureField(const Mask& frame, const Grid& grid, const StageToFrame& map) {
  double x1_m = -std::numeric_limits<double>::infinity();
  double y1_m = x1_m;
  x0_m_ = y0_m_ = std::numeric_limits<double>::infinity();
  for (int row = 0; row < grid.rows(); ++row) {
    for (const int column : {0, std::min(1, grid.columns() - 1), grid.columns() - 1}) {
      const Point centre = grid.centre(Cell{column, row});
      x0_m_ = std::min(x0_m_, centre.x);
      x1_m = std::max(x1_m, centre.x);
      y0_m_ = std::min(y0_m_, centre.y);
      y1_m = std::max(y1_m, centre.y);
    }
  }
  per_m_ = kPointsPerPitch / grid.pitch_m();
  columns_ = static_cast<std::size_t>((x1_m - x0_m_) * per_m_ + 0.5) + 2;
  const std::size_t rows = static_cast<std::size_t>((y1_m - y0_m_) * per_m_ + 0.5) + 2;
  const SummedArea picture(frame);
  const double cell_px = grid.cell_area_m2() * std::abs(map[0] * map[4] - map[1] * map[3]);
  const double half = std::sqrt(cell_px) / 2;
  area_cells_ = static_cast<double>(picture.total()) / cell_px;
  rho_.resize(columns_ * rows);
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t c = 0; c < columns_; ++c) {
      const Point at{x0_m_ + static_cast<double>(c) / per_m_, y0_m_ + static_cast<double>(r) / per_m_};
      const double x = map[0] * at.x + map[1] * at.y + map[2];
      const double y = map[3] * at.x + map[4] * at.y + map[5];
      const double area = picture.area(x - half, y - half, x + half, y + half);
      rho_[r * columns_ + c] = static_cast<float>(std::clamp(area / cell_px, 0.0, 1.0));
    }
  }
}

}  // namespace footlight::planner
