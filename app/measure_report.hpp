// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/plan.hpp"
#include "planner/measure.hpp"

namespace footlight::app {

/// A table of a line for each section and one for the show.
[[nodiscard]] std::string measure_text(const Plan& plan, const planner::ShowMeasures& measures);
/// The same for programs; figures that do not exist are null (no film, one performer).
[[nodiscard]] std::string measure_json(const Plan& plan, const planner::ShowMeasures& measures);

}  // namespace footlight::app
