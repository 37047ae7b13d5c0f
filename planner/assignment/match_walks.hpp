// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "planner/assignment/arc_rows.hpp"
#include "planner/assignment/walks.hpp"

namespace footlight::planner::assignment {

/// The cheapest perfect matching of the walks and a dual solution that proves it: cost + price - value >= 0 for every
/// allowed walk (all of them priced, not only those that were candidates) and = 0 for the matched ones, in integers.
/// @return nothing when no perfect matching of allowed walks exists, or none was found in bounded work, or when stopped
[[nodiscard]] std::optional<Matching> match_walks(const Walks& walks, const std::atomic<bool>* stop);

}  // namespace footlight::planner::assignment
