// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "planner/painted/stroke.hpp"

namespace footlight::planner {

/// Which way to go, at the middle of every pixel; y down as in the picture.
struct FlowField {
  Raster<Point> direction;  ///< of length 1, or 0 where the stroke is out of reach
  Raster<double> strength;  ///< 0..1: 1 on the middle line, falling with the distance from it
};

/// The field of a stroke over a picture.
///
/// Source: Kang, Kim 2014, Eq. 3: v_xy = sum_i (r_{i+1} - r_i) phi(|G_xy - r_i|, h). phi is Gaussian, exp(-(d / h)^2),
/// h the stroke's half width at r_i. Printed as it is the sum's length depends on how densely the line is sampled; here
/// its direction is the field's, and the largest phi is its strength. Beyond 2.5 h a point of the line adds nothing.
/// O(points of the line x pixels in reach)
[[nodiscard]] FlowField flow_field(const Stroke& stroke, int width, int height);

/// phi of Eq. 3. @param away_px, half_width_px > 0
[[nodiscard]] double radial_basis(double away_px, double half_width_px);

/// Eq. 3 at one point as it is printed, not normalised. @param strength the largest phi
[[nodiscard]] Point stroke_velocity(const Stroke& stroke, Point pixel, double& strength);

}  // namespace footlight::planner
