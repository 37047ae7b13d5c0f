// SPDX-License-Identifier: Apache-2.0
#include "planner/judge/geometry.hpp"

#include <cmath>
#include <cstddef>

#include "planner/judge/time_polygon.hpp"

namespace footlight::planner::judge {
namespace {

double point_to_segment_squared(Point p, Point a, Point b) { return nearest_to_origin(a - p, b - p).squared_m2; }

bool cross_each_other(Point a, Point b, Point c, Point d) {
  const double side_c = cross(b - a, c - a);
  const double side_d = cross(b - a, d - a);
  const double side_a = cross(d - c, a - c);
  const double side_b = cross(d - c, b - c);
  return ((side_c > 0) != (side_d > 0)) && ((side_a > 0) != (side_b > 0));
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
  const TimePolygon polygon = polygon_of(box).clipped(1, lag_s).clipped(-1, lag_s);
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
  const bool meets = inside(zero, polygon.view());
  return meets ? 0.0 : best;
}

}  // namespace footlight::planner::judge
