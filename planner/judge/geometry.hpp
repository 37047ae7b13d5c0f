// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>
#include <span>

#include "core/grid.hpp"

namespace footlight::planner::judge {

/// An axis-parallel box, metres; empty until a point is added.
struct Box {
  double x0 = std::numeric_limits<double>::infinity();
  double y0 = std::numeric_limits<double>::infinity();
  double x1 = -std::numeric_limits<double>::infinity();
  double y1 = -std::numeric_limits<double>::infinity();

  void add(Point p) {
    x0 = std::min(x0, p.x);
    y0 = std::min(y0, p.y);
    x1 = std::max(x1, p.x);
    y1 = std::max(y1, p.y);
  }
  /// Moves every side out by `by_m`.
  void grow(double by_m) {
    x0 -= by_m;
    y0 -= by_m;
    x1 += by_m;
    y1 += by_m;
  }
};

[[nodiscard]] inline bool overlap(const Box& a, const Box& b) {
  return a.x0 <= b.x1 && b.x0 <= a.x1 && a.y0 <= b.y1 && b.y0 <= a.y1;
}

/// The point of the segment d0 -> d1 that is nearest to the origin.
struct Nearest {
  double squared_m2 = 0;
  double share = 0;  ///< 0 at d0, 1 at d1; the earliest where several are nearest
};

/// Closest approach of two people who walk straight: d0 and d1 are their difference at the start and at the end.
[[nodiscard]] inline Nearest nearest_to_origin(Point d0, Point d1) {
  const Point way = d1 - d0;
  const double squared = squared_length(way);
  const double share = squared > 0 ? std::clamp(-dot(d0, way) / squared, 0.0, 1.0) : 0.0;
  return {squared_length(d0 + share * way), share};
}

/// Least distance, metres, of the segment a -> b from a convex polygon and its inside; 0 where they touch.
/// @param corners at least three, counter-clockwise
[[nodiscard]] double segment_to_polygon_m(Point a, Point b, std::span<const Point> corners);

/// Two people on straight walks whose positions are d0 + s v and w u apart: times s and u chosen independently.
struct IndependentWalks {
  Point d0;  ///< difference at s = u = 0, m
  Point v;   ///< velocity of the first, m/s
  Point w;   ///< velocity of the second, m/s
};
/// A rectangle of times, seconds.
struct TimeBox {
  double s0 = 0;
  double s1 = 0;
  double u0 = 0;
  double u1 = 0;
};

/// min |d0 + v s - w u|^2, m^2, over the times in `box` with |s - u| <= lag_s; infinity where there are none.
[[nodiscard]] double least_squared_m2(const IndependentWalks& walks, const TimeBox& box, double lag_s);

}  // namespace footlight::planner::judge
