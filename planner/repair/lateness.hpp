// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "planner/repair/closest_approach.hpp"

namespace footlight::planner {

/// A straight walk in a part of the time that two formations lie apart: she stands before it and after it.
struct TimedWalk {
  Walk walk;
  double start = 0;  ///< share of the time at which she leaves, in [0, end)
  double end = 1;    ///< share of the time at which she is there, in (start, 1]
};

/// Least squared distance of two people when each may be late by up to `share` of the time, independently of the other:
/// the minimum of |a(s) - b(u)| over s, u in [0, 1] with |s - u| <= share, closed form. On each pair of straight pieces
/// the square of the distance is convex in both clocks, so its least lies on an edge of the polygon of the clocks or is
/// 0 inside of it.
/// @param share in [0, 1]; 0 is the closest approach of two who are punctual  @return m^2. O(1)
[[nodiscard]] double least_squared_when_late_m2(const TimedWalk& a, const TimedWalk& b, double share);

/// Where somebody is at a share of the time; straight and at constant speed to the next one.
struct Knot {
  double at = 0;
  Point point;
};

/// The same for walks with marks on the way, or parts of such walks: only what lies between the first and the last knot
/// is looked at. @param a, b ascending in time, at least two knots  @return infinity when they are never there together
[[nodiscard]] double least_squared_along_m2(std::span<const Knot> a, std::span<const Knot> b, double share);

}  // namespace footlight::planner
