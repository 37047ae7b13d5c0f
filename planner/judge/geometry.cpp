// SPDX-License-Identifier: Apache-2.0
#include "planner/judge/geometry.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace footlight::planner::judge {
namespace {

double cross(Point a, Point b) { return a.x * b.y - a.y * b.x; }

bool inside(Point p, std::span<const Point> corners) {
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Point from = corners[k];
    const Point to = corners[(k + 1) % corners.size()];
    if (cross(to - from, p - from) < 0) return false;
  }
  return true;
}

double point_to_segment_squared(Point p, Point a, Point b) { return nearest_to_origin(a - p, b - p).squared_m2; }

bool cross_each_other(Point a, Point b, Point c, Point d) {
  const double side_c = cross(b - a, c - a);
  const double side_d = cross(b - a, d - a);
  const double side_a = cross(d - c, a - c);
  const double side_b = cross(d - c, b - c);
  return ((side_c > 0) != (side_d > 0)) && ((side_a > 0) != (side_b > 0));
}

/// A convex polygon of times with room for a rectangle that two lines have clipped.
struct TimePolygon {
  std::array<Point, 8> corners;  // x = s, y = u
  std::size_t size = 0;

  void add(Point p) { corners[size++] = p; }
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

Point difference(const IndependentWalks& walks, Point times) {
  return walks.d0 + times.x * walks.v - times.y * walks.w;
}

}  // namespace

double segment_to_polygon_m(Point a, Point b, std::span<const Point> corners) {
  if (inside(a, corners) || inside(b, corners)) return 0;
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Point c = corners[k];
    const Point d = corners[(k + 1) % corners.size()];
    if (cross_each_other(a, b, c, d)) return 0;
    best = std::min({best, point_to_segment_squared(c, a, b), point_to_segment_squared(a, c, d),
                     point_to_segment_squared(b, c, d)});
  }
  return std::sqrt(best);
}

double least_squared_m2(const IndependentWalks& walks, const TimeBox& box, double lag_s) {
  TimePolygon whole;
  whole.add({box.s0, box.u0});
  whole.add({box.s1, box.u0});
  whole.add({box.s1, box.u1});
  whole.add({box.s0, box.u1});
  const TimePolygon polygon = whole.clipped(1, lag_s).clipped(-1, lag_s);
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < polygon.size; ++k) {
    const Point from = difference(walks, polygon.corners[k]);
    const Point to = difference(walks, polygon.corners[(k + 1) % polygon.size]);
    best = std::min(best, nearest_to_origin(from, to).squared_m2);
  }
  // The squared distance is convex in (s, u), so inside of the polygon it is least only where it is 0, and where v and
  // w are parallel that is reached on the border, too.
  const double determinant = cross(walks.w, walks.v);
  if (!(polygon.area() > 1e-18) || std::abs(determinant) < 1e-12) return best;
  const Point zero{cross(walks.d0, walks.w) / determinant, cross(walks.d0, walks.v) / determinant};
  const bool meets = inside(zero, std::span(polygon.corners).first(polygon.size));
  return meets ? 0.0 : best;
}

}  // namespace footlight::planner::judge
