// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "planner/schedule/snap.hpp"
#include "planner/schedule/walks.hpp"
#include "planner/stages.hpp"

namespace footlight::planner {

/// Walks over neighbouring cells between two instants.
struct CellSteps {
  int most = 0;       ///< so many there is time for
  double step_s = 1;  ///< that one takes
};

/// Everybody from one instant to the next.
struct StepTask {
  SnapTask snap;                             ///< without `hold` and `slow`; a goal of kNoGoal binds nobody
  bool exact = false;                        ///< everybody goes to `snap.own`
  std::span<const CellIndex> next_own = {};  ///< where `snap.onward` wants those who want their own cell
  double clearance_m = 0.5;
  std::span<const std::uint32_t> kind = {};  ///< as LegTask::kind
  std::span<const double> radius_m = {};     ///< as LegTask::radius_m
  double walked_s = 0;                       ///< time between the two instants
  double lag_s = 0;                          ///< how late anybody may be
  double wait_s = 0;                         ///< who waits, waits for multiples of this; 0: nobody does
  std::optional<CellSteps> over_cells;       ///< absent: everybody walks straight
  const std::atomic<bool>* stop = nullptr;   ///< as LegTask::stop; a step that was stopped is not kept as a stage
};

struct Step {
  std::vector<CellIndex> cells;  ///< of each slot
  Leg leg;
  /// Over cells: where everybody is after each step, numbered as before the walk. On the way to an exact formation
  /// there may be more steps than there is time for.
  std::vector<std::vector<CellIndex>> after;
};

/// Snaps and pairs; who conflicts waits, and whoever conflicts with those, until nobody does. If all waited nobody
/// would, so it ends. Who conflicts only when people are late walks more slowly: two people of whom one is slow enough
/// cannot use up by lateness what walks keep by themselves; after a bounded number of rounds the best one is taken and
/// what is left stands in `leg.late_conflicts`. Over cells whoever does not come to where the snap wants her stands
/// where the steps have brought her; nobody follows so closely that lateness is not tolerated, unless an exact
/// formation cannot be reached otherwise. The result does not depend on how the slots are numbered.
[[nodiscard]] Step walk_step(const StepTask& task);

/// The same as a stage. @param floor hash of the grid and what is blocked on it
[[nodiscard]] Step walk_step(const StepTask& task, const StageKey& floor, Stages* stages, StageCount* count);

}  // namespace footlight::planner
