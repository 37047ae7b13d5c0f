// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "core/plan.hpp"
#include "planner/judge/walks.hpp"

namespace footlight::planner::judge {

/// Allowed errors of a plan's doubles.
inline constexpr double kClearanceTolerance_m = 1e-6;
inline constexpr double kSpeedTolerance = 1e-6;      ///< relative
inline constexpr double kBlockedTolerance_m = 1e-9;  ///< of a walk's distance from a blocked cell

/// How near two people may come: the stage's clearance, or the sum of their radii where that is more, metres.
[[nodiscard]] inline double least_distance_m(const Plan& plan, std::uint32_t a, std::uint32_t b) {
  return std::max(plan.stage.clearance_m, plan.radius_m[a] + plan.radius_m[b]);
}

/// Two people and the instant at which they are nearest to each other.
struct NearestPair {
  double distance_m = std::numeric_limits<double>::infinity();
  Instant at;
  std::uint32_t a = 0;
  std::uint32_t b = 0;  ///< > a
};

struct Approaches {
  NearestPair nearest;             ///< of all pairs, exact; at an infinite distance when there are not two people
  std::uint64_t too_close = 0;     ///< pairs and stretches between neighbouring mark instants
  std::vector<NearestPair> first;  ///< pairs too close on a straight stretch of both; the first `keep` by time
};

/// Closest approaches in [start, end], in closed form. Stretches of time are judged in parallel; the result does not
/// depend on how.
///
/// In each stretch the pairs that come within sight are found first, by a tree; a pair is then measured over the whole
/// stretch. Complexity: O(marks log marks + near pairs). Thread: reentrant.
[[nodiscard]] Approaches find_approaches(const Plan& plan, const Walks& walks, Instant start, Instant end,
                                         std::size_t keep);

}  // namespace footlight::planner::judge
