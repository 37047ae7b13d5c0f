// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "app/edit/plan_process.hpp"
#include "app/edit/walk_changes.hpp"
#include "app/show_on_wires.hpp"
#include "config/show_file.hpp"
#include "controller/stands.hpp"
#include "core/plan.hpp"

namespace footlight::app {

/// What plays while something else is prepared. Borrowed parts live until that is ready.
struct PlayingNow {
  std::shared_ptr<const Plan> plan;
  std::shared_ptr<const Rig> rig;
  const ShowOnWires* wires = nullptr;                 ///< drivers and loops
  const controller::CueSchedule* schedule = nullptr;  ///< whose looks the markers hold
};

/// A show that could play instead: read, planned in a process of its own, judged, and compiled for the running wires.
struct ComingShow {
  config::LoadedShow loaded;  ///< without whom the plan does without
  Show everybody;             ///< performers and understudies as the file has them
  Plan plan;
  WalkChanges changes;
  std::unique_ptr<ShowOnWires> wires;
  std::vector<controller::TempoLimit> limits;
  controller::Stands stands;
};

/// Errors: whatever show, plan or wires have wrong, positioned; refused for a rig with other nodes than the running
/// one; interrupted when told to stop or when the show has changed meanwhile. For a thread that may take its time.
[[nodiscard]] Result<std::unique_ptr<ComingShow>> prepare_show(const PlanOrder& order, const PlayingNow& playing,
                                                               const std::atomic<bool>& stop);

}  // namespace footlight::app
