// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "planner/judge/geometry.hpp"

namespace footlight::planner::judge {

[[nodiscard]] inline double cross(Point a, Point b) { return a.x * b.y - a.y * b.x; }

/// Whether a point lies in a convex polygon or on its border. @param corners counter-clockwise
[[nodiscard]] inline bool inside(Point p, std::span<const Point> corners) {
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Point from = corners[k];
    const Point to = corners[(k + 1) % corners.size()];
    if (cross(to - from, p - from) < 0) return false;
  }
  return true;
}

/// A convex polygon of times with room for a rectangle that three lines have clipped.
struct TimePolygon {
  std::array<Point, 10> corners;  ///< x = s, y = u, seconds
  std::size_t size = 0;

  void add(Point p) { corners[size++] = p; }
  [[nodiscard]] std::span<const Point> view() const { return std::span(corners).first(size); }
  [[nodiscard]] double area() const {
    double twice = 0;
    for (std::size_t k = 2; k < size; ++k) twice += cross(corners[k - 1] - corners[0], corners[k] - corners[0]);
    return twice / 2;
  }
  /// Keeps the part where sign * (u - s) <= lag_s.
  [[nodiscard]] TimePolygon clipped(double sign, double lag_s) const {
    TimePolygon out;
    for (std::size_t k = 0; k < size; ++k) {
      const Point p = corners[k];
      const Point q = corners[(k + 1) % size];
      const double over_p = sign * (p.y - p.x) - lag_s;
      const double over_q = sign * (q.y - q.x) - lag_s;
      if (over_p <= 0) out.add(p);
      if ((over_p < 0 && over_q > 0) || (over_p > 0 && over_q < 0)) {
        out.add(p + (over_p / (over_p - over_q)) * (q - p));
      }
    }
    return out;
  }
};

[[nodiscard]] inline TimePolygon polygon_of(const TimeBox& box) {
  TimePolygon polygon;
  polygon.add({box.s0, box.u0});
  polygon.add({box.s1, box.u0});
  polygon.add({box.s1, box.u1});
  polygon.add({box.s0, box.u1});
  return polygon;
}

/// Where the first is, seen from the second, at times (s, u).
[[nodiscard]] inline Point difference(const IndependentWalks& walks, Point times) {
  return walks.d0 + times.x * walks.v - times.y * walks.w;
}

}  // namespace footlight::planner::judge
