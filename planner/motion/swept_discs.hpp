// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/show.hpp"
#include "planner/schedule/ways.hpp"
#include "planner/stages.hpp"

namespace footlight::planner {

/// Where the moving obstacles of a show are between two instants, each while its section lasts, one straight piece
/// each. Empty when `to` is before `from`. O(sections + obstacles x their places)
[[nodiscard]] std::vector<SweptDisc> swept_discs(const Show& show, Instant from, Instant to);

/// Of `Ways::beside`, as `floor` is of the floor without discs.
[[nodiscard]] StageKey floor_with_discs(const StageKey& floor, const std::vector<SweptDisc>& during,
                                        const std::vector<SweptDisc>& after);

/// Whether anything moves through any section.
[[nodiscard]] bool has_moving_obstacles(const Show& show);

}  // namespace footlight::planner
