// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "planner/assignment/arc_rows.hpp"

namespace footlight::planner::assignment {

/// The cheapest perfect matching of a full table of costs, and its dual solution, by shortest augmenting paths after a
/// column reduction (Jonker and Volgenant 1987, without their reduction transfer). The right tool below a hundred or
/// two. O(size^3)
///
/// @param costs size x size, row by row of the sources, 0 <= cost, size x cost < kFar; from kFar on: forbidden
/// @return source_of is kNobody somewhere when there is no matching without a forbidden pair
[[nodiscard]] Matching match_dense(std::uint32_t size, std::span<const Value> costs);

}  // namespace footlight::planner::assignment
