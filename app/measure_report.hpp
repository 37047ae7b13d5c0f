// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/plan.hpp"
#include "planner/formation/best_single.hpp"
#include "planner/measure.hpp"

namespace footlight::app {

/// The best formation of each single frame, for each section; absent without a film.
using SectionBests = std::vector<std::optional<planner::SingleFigures>>;

/// A table of a line for each section and one for the show.
/// @param bests for each section, or empty: not asked for
[[nodiscard]] std::string measure_text(const Plan& plan, const planner::ShowMeasures& measures,
                                       const SectionBests& bests = {});
/// The same for programs; figures that do not exist are null (no film, one performer).
[[nodiscard]] std::string measure_json(const Plan& plan, const planner::ShowMeasures& measures,
                                       const SectionBests& bests = {});

}  // namespace footlight::app
