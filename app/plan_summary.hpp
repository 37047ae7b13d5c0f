// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/show.hpp"
#include "planner/plan_show.hpp"

namespace footlight::app {

/// What a plan asks of its people: a line for each section, what the planner says of it, the shortest durations.
[[nodiscard]] std::string plan_text(const Show& show, const planner::Planned& planned);
[[nodiscard]] std::string plan_json(const Show& show, const planner::Planned& planned);

/// Shares of manual work, a line; empty where nothing was done by hand.
[[nodiscard]] std::string by_hand_text(const Plan& plan);

/// "section growth: at least 180 counts (it has 224); limited by ...", a line for each section that has one.
[[nodiscard]] std::string shortest_text(const Show& show, const planner::Planned& planned);

}  // namespace footlight::app
