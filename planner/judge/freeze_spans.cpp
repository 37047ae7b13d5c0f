// SPDX-License-Identifier: Apache-2.0
#include "planner/judge/freeze_spans.hpp"

#include <algorithm>
#include <cmath>

#include "planner/judge/time_polygon.hpp"

namespace footlight::planner::judge {
namespace {

/// Where s and u may be while the two are nearer than the limit.
struct Extent {
  TimeRange s;
  TimeRange u;
  void add(Point times) {
    s = {std::min(s.first, times.x), std::max(s.last, times.x)};
    u = {std::min(u.first, times.y), std::max(u.last, times.y)};
  }
};

/// The points of an edge at which the distance is just the limit: |from + share (to - from)| = limit.
void add_crossings(Point p, Point q, const IndependentWalks& walks, double limit_m, Extent& extent) {
  const Point from = difference(walks, p);
  const Point way = difference(walks, q) - from;
  const double a = squared_length(way);
  const double half_b = dot(from, way);
  const double discriminant = half_b * half_b - a * (squared_length(from) - limit_m * limit_m);
  if (!(a > 0) || discriminant < 0) return;
  const double root = std::sqrt(discriminant);
  for (const double share : {(-half_b - root) / a, (-half_b + root) / a}) {
    if (share >= 0 && share <= 1) extent.add(p + share * (q - p));
  }
}

/// Where the ellipse of the times at the limit has its own extremes of s and of u: there the other one's velocity is
/// along the border.
void add_tangents(const TimePolygon& polygon, const IndependentWalks& walks, double limit_m, Extent& extent) {
  const double determinant = cross(walks.v, walks.w);
  if (std::abs(determinant) < 1e-12) return;  // no ellipse but a strip: the polygon's edges end it
  const double v2 = squared_length(walks.v);
  const double w2 = squared_length(walks.w);
  for (const double side_m : {-limit_m, limit_m}) {
    const double s = (side_m * std::sqrt(w2) - cross(walks.d0, walks.w)) / determinant;
    const Point at_s{s, dot(walks.d0 + s * walks.v, walks.w) / w2};
    if (inside(at_s, polygon.view())) extent.add(at_s);
    const double u = (cross(walks.d0, walks.v) - side_m * std::sqrt(v2)) / -determinant;
    const Point at_u{dot(u * walks.w - walks.d0, walks.v) / v2, u};
    if (inside(at_u, polygon.view())) extent.add(at_u);
  }
}

Extent extent_of(const TimePolygon& polygon, const IndependentWalks& walks, double limit_m) {
  Extent extent;
  if (polygon.size < 3) return extent;
  for (std::size_t k = 0; k < polygon.size; ++k) {
    const Point corner = polygon.corners[k];
    if (squared_length(difference(walks, corner)) < limit_m * limit_m) extent.add(corner);
    add_crossings(corner, polygon.corners[(k + 1) % polygon.size], walks, limit_m, extent);
  }
  add_tangents(polygon, walks, limit_m, extent);
  return extent;
}

}  // namespace

FreezeSpans freeze_spans(const IndependentWalks& walks, const TimeBox& box, double late_s, double limit_m) {
  const TimePolygon both = polygon_of(box).clipped(1, late_s).clipped(-1, late_s);
  const Extent first_ahead = extent_of(both.clipped(1, 0), walks, limit_m);    // u <= s
  const Extent second_ahead = extent_of(both.clipped(-1, 0), walks, limit_m);  // s <= u
  FreezeSpans out;
  out.freeze = {std::min(first_ahead.s.first, second_ahead.u.first) - late_s,
                std::max(first_ahead.u.last, second_ahead.s.last)};
  if (!first_ahead.u.empty()) out.resume_first = {box.s0 - late_s, first_ahead.u.last};
  if (!second_ahead.s.empty()) out.resume_second = {box.u0 - late_s, second_ahead.s.last};
  return out;
}

}  // namespace footlight::planner::judge
