// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/grid.hpp"

namespace footlight::planner {

/// A straight walk at constant speed; walks that are compared start and arrive together.
struct Walk {
  Point from;
  Point to;
};

/// When two people are nearest to each other.
struct Approach {
  double distance_m = 0;
  double share = 0;  ///< of the time, 0..1
};

/// Closed form: the least of |d0 + (d1 - d0) share| over [first, last] of the time.
[[nodiscard]] Approach closest_approach(const Walk& a, const Walk& b, double first = 0, double last = 1);

/// Two people who come near, a < b.
struct NearPair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  Approach approach;
};

/// Every pair whose walks come nearer than `reach_m`, ascending (a, b). O(n log n + pairs that come near)
/// @param among one flag a person: only pairs with at least one flagged person are looked for; empty: all pairs
[[nodiscard]] std::vector<NearPair> near_pairs(std::span<const Walk> walks, double reach_m,
                                               std::span<const char> among = {});

/// The nearest two of all, the first (a, b) among equals. Infinity and 0, 0 for one person.
[[nodiscard]] NearPair nearest_pair(std::span<const Walk> walks);

}  // namespace footlight::planner
