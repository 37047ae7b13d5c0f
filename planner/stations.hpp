// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/film.hpp"
#include "planner/plan_section.hpp"
#include "planner/stages.hpp"

namespace footlight::planner {

struct StationsTask {
  const Show* show = nullptr;
  const Show* limits = nullptr;  ///< the same show with the limits of speed that walks are planned for
  const std::vector<std::optional<Film>>* films = nullptr;  ///< one for each section, absent where not needed
  const Ways* ways = nullptr;
  const Reuse* reuse = nullptr;
};

struct CollectedStations {
  std::vector<Station> stations;  ///< of all sections, ascending by time, with what is changed by hand
  std::vector<PlanSection> sections;
  StageCount count;  ///< of sections
};

/// The formations of a whole show, taken from the stages where they are known. Films that may begin where it is best
/// are planned at the same time, as if nobody had been anywhere before; those that cannot be reached so are planned
/// again.
/// @return as `plan_section` and `apply_overrides`
[[nodiscard]] Result<CollectedStations> collect_stations(const StationsTask& task, const Progress& progress);

/// For each section whether its formations are among the stages. Films are not looked at.
[[nodiscard]] std::vector<bool> sections_known(const StationsTask& task);

}  // namespace footlight::planner
