// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "planner/assignment/arc_rows.hpp"

namespace footlight::planner::assignment {

/// One phase of an auction (Bertsekas 1988): everybody starts free and bids, one after another, the last one displaced
/// first (which keeps to the cache), until all have a target or the bids are used up. Afterwards each matched pair is
/// within `step` of its source's best.
///
/// @param matching prices are the starting point; the matching is replaced
/// @param most_bids bound for what a few can do to each other in a price war; who is free then stays free
void hold_auction(const ArcRows& rows, Value step, std::uint64_t most_bids, Matching& matching);

}  // namespace footlight::planner::assignment
