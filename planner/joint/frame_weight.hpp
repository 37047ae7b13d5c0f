// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace footlight::planner {

/// How much theta_iou counts beside theta_dev. Both gaps close about equally at this.
inline constexpr double kIouWeight = 1.5;

/// What a frame gains by somebody with a share rho of picture around her: alpha rho - beta. The gradient of
/// theta_dev + kIouWeight theta_iou at `people` people who cover `covered` of a picture of `area`, all in cells.
struct FrameWeight {
  double alpha = 0;
  double beta = 0;
};
[[nodiscard]] FrameWeight frame_weight(double people, double covered, double area);

}  // namespace footlight::planner
