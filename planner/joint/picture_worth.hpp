// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/film.hpp"
#include "core/grid.hpp"
#include "core/plan.hpp"

namespace footlight::planner {

/// What a frame gains by somebody with a share rho of picture around her: alpha rho - beta. The gradient of
/// theta_dev + theta_iou at `people` people who cover `covered` of a picture of `area`, all in cells.
struct FrameWeight {
  double alpha = 0;
  double beta = 0;
};
[[nodiscard]] FrameWeight frame_weight(double people, double covered, double area);

/// rho (Li 2020 Eq. 8) of one frame all over the floor, at points a quarter of a pitch apart.
class PictureField {
 public:
  static constexpr int kPointsPerPitch = 4;

  PictureField(const Mask& frame, const Grid& grid, const StageToFrame& map);

  /// At the nearest point of the field; outside of the floor the nearest on it. O(1)
  [[nodiscard]] float at(double x_m, double y_m) const {
    const auto column = static_cast<std::size_t>((x_m - x0_m_) * per_m_ + 0.5);
    const auto row = static_cast<std::size_t>((y_m - y0_m_) * per_m_ + 0.5);
    return rho_[row * columns_ + column];
  }
  /// Of the whole picture, on the floor or not, in cells.
  [[nodiscard]] double area_cells() const { return area_cells_; }

 private:
  double x0_m_ = 0;
  double y0_m_ = 0;
  double per_m_ = 1;
  std::size_t columns_ = 0;
  std::vector<float> rho_;
  double area_cells_ = 0;
};

}  // namespace footlight::planner
