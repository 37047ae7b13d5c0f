// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "core/grid.hpp"

namespace footlight::planner {

[[nodiscard]] inline double cross(Point a, Point b) { return a.x * b.y - a.y * b.x; }

/// The point of the straight line from `a` to `b` that is nearest to `p`.
[[nodiscard]] inline Point nearest_on(Point p, Point a, Point b) {
  const Point along = b - a;
  const double square = squared_length(along);
  const double share = square > 0 ? std::clamp(dot(p - a, along) / square, 0.0, 1.0) : 0.0;
  return a + share * along;
}

}  // namespace footlight::planner
