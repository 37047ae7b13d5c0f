// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/plan.hpp"
#include "planner/formation/best_single.hpp"
#include "planner/joint/drawing_bound.hpp"
#include "planner/measure.hpp"

namespace footlight::app {

/// The best formation of each single frame, for each section; absent without a film.
using SectionBests = std::vector<std::optional<planner::SingleFigures>>;

/// What nobody who keeps the limit of speed can beat, for each section; absent without a film.
using SectionBounds = std::vector<std::optional<planner::DrawingBound>>;

/// A plan and everything that was measured of it.
struct MeasuredPlan {
  std::string file;  ///< as the user named it
  Plan plan;
  planner::ShowMeasures measures;
  std::vector<double> lag_s;         ///< tolerated, one for each of the plan's transitions
  SectionBests bests;                ///< empty: not asked for
  SectionBounds bounds;              ///< empty: not asked for
  std::optional<double> planning_s;  ///< absent when the plan came from a file
};

/// Four tables, of the drawing, of clearances, of ways and of how the crowd moves, with a line for each section and one
/// for the show; of several plans with a line for each plan instead.
/// @param plans at least one
[[nodiscard]] std::string measure_text(const std::vector<MeasuredPlan>& plans);
/// The same for programs; figures that do not exist are null (no film, one performer). One plan is an object, several
/// are `plans` in one.
[[nodiscard]] std::string measure_json(const std::vector<MeasuredPlan>& plans);

}  // namespace footlight::app
