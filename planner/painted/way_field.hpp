// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "planner/painted/raster.hpp"

namespace footlight::planner {

/// The shortest free way to some pixels from all others.
struct WayField {
  Raster<double> length_px;  ///< infinite where there is none
  Raster<Point> direction;   ///< of length 1, along the way; 0 in the goal and where there is none
};

/// Source: fast marching (Sethian, "A fast marching level set method for monotonically advancing fronts", PNAS 93,
/// 1996): first order upwind solution of |grad length| = 1. O(pixels log pixels)
[[nodiscard]] WayField way_field(const PixelSet& blocked, const PixelSet& goal);

/// Whether nothing blocked lies on the straight line between two points, nor right beside it farther than a pixel from
/// where it begins: what pixels show is not exact. O(pixels passed)
/// @param away distance of each pixel's middle to the nearest blocked one's
[[nodiscard]] bool sees(const Raster<double>& away, Point from, Point to);

}  // namespace footlight::planner
