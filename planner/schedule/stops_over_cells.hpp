// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/show.hpp"
#include "planner/schedule/beats.hpp"
#include "planner/schedule/chain.hpp"

namespace footlight::planner {

/// Where a leg's slots are after each of its steps; empty: nobody walks.
using StepsOfLeg = std::vector<std::vector<CellIndex>>;

/// Over cells everybody stands on a cell after each step. Whoever is there before the time waits; an exact formation
/// that takes more steps than there is time for gets them all the same, too fast, for the refusal to tell how many.
/// @param chain with straight legs  @param after, beats  of each leg
/// @return the chain with a stop after each step. O(places of all steps)
[[nodiscard]] Chain stops_over_cells(Chain chain, const std::vector<StepsOfLeg>& after, const std::vector<Beats>& beats,
                                     const Show& show);

}  // namespace footlight::planner
