// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/film.hpp"
#include "core/plan.hpp"
#include "core/result.hpp"
#include "core/show.hpp"
#include "planner/progress.hpp"
#include "planner/stages.hpp"

namespace footlight::planner {

/// Places everybody at every mark of the show and proves it (`validate` has run on what is returned; `plan.valid` is
/// its word).
///
/// A plan that breaks a limit is returned all the same, with valid == false and `refusal` set: it can be measured and
/// looked at and never reaches a marker.
struct Planned {
  Plan plan;
  /// Why the plan is refused, one positioned line each, most important first; empty when it is valid. For people and
  /// for tests.
  std::vector<std::string> refusal;
  /// Shortest duration of each section that can be walked at the speed limit without the drawing giving way, counts,
  /// and what limits it.
  struct Shortest {
    double counts = 0;
    std::string limited_by;
  };
  std::vector<std::optional<Shortest>> shortest;
  StageCount formations;  ///< of a section, without what is changed by hand
  StageCount pairings;    ///< of two formations
  StageCount walks;       ///< of everybody from instant to instant
  StageCount facts;       ///< of a transition, and its proof
};

/// @param films one for each section, absent for explicit cells and where the formations are known
/// @return ErrorKind::input when there is nothing to plan (more people than cells, positioned), interrupted when told
/// to stop Complexity: see docs/algorithms/. Deterministic, byte-equal for any number of threads. Thread: reentrant.
[[nodiscard]] Result<Planned> plan_show(const Show& show, const std::vector<std::optional<Film>>& films,
                                        const Progress& progress = {}, const Reuse& reuse = {});

/// For each section whether its formations are among the stages, so that `plan_show` does not ask for its film.
[[nodiscard]] std::vector<bool> formations_known(const Show& show, const Reuse& reuse);

}  // namespace footlight::planner
