// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "planner/judge/geometry.hpp"

namespace footlight::planner::judge {

/// Instants from `first` to `last`, seconds; none where `first` > `last`.
struct TimeRange {
  double first = std::numeric_limits<double>::infinity();
  double last = -std::numeric_limits<double>::infinity();
  [[nodiscard]] bool empty() const { return first > last; }
};

/// At which instants two people may not be stopped, for one straight stretch of each.
struct FreezeSpans {
  TimeRange freeze;
  TimeRange resume_first;   ///< the first is ahead of the show, the second perhaps, but less
  TimeRange resume_second;  ///< the second is the one who is further ahead
};

/// Stopped at T, each stands where her way has led her at some instant of [T, T + late_s], whichever it was for the
/// other: they may touch when a pair (s, u) of instants, in the stretches and both in [T, T + late_s], has them nearer
/// than `limit_m`. Those pairs are where a convex quadratic is below a bound on a convex polygon, so the T are one
/// range, from (least max(s, u)) - late_s to the greatest min(s, u).
///
/// Going on from T, each is ahead of the show by 0 to late_s until the end of the stretch that she was stopped in, or
/// has got into: (s, u) with s > u is a danger from T > (begin of the first's stretch) - late_s on until T = u.
/// @param box the stretches, seconds: [s0, s1] of the first, [u0, u1] of the second
/// Closed form: each bound is a linear function's extreme over ellipse and polygon, found at a corner of the polygon,
/// where an edge of it crosses the ellipse, or at a tangent of the ellipse. O(1)
[[nodiscard]] FreezeSpans freeze_spans(const IndependentWalks& walks, const TimeBox& box, double late_s,
                                       double limit_m);

}  // namespace footlight::planner::judge
