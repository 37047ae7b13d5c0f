// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "app/live/cue_thread.hpp"
#include "app/show_on_wires.hpp"
#include "controller/stands.hpp"
#include "controller/tempo_limit.hpp"
#include "core/plan.hpp"
#include "core/tempo_map.hpp"

namespace footlight::app {

/// Another plan for a run, ready to be played from `to` on, and nothing that belongs to the one that plays.
struct ComingPlan {
  std::unique_ptr<ShowOnWires> wires;  ///< put_beside, its engine limited
  TempoMap tempo;
  controller::Stands stands;
  std::vector<controller::TempoLimit> limits{};
  Instant from{};  ///< where the show stands in the plan that plays
  Instant to{};    ///< where it will stand in this one
  /// The way of everybody to there, a reset move of `wires->schedule` that begins with where people stand
  /// (build_reset); nothing: they stand there.
  std::optional<std::size_t> way{};
  std::shared_ptr<const Plan> walks{};  ///< of that way, for who shows it
};

/// Whoever brings other plans into a run. Called by the calling thread of the run.
class PlanChanges {
 public:
  virtual ~PlanChanges() = default;
  /// Before the first byte. @param wires whose drivers and loops stay for the whole run
  virtual void begin(const ShowOnWires& wires) = 0;
  /// A plan to go over to now, when the show stands; null: none. Asked again and again, not while one is under way
  virtual std::unique_ptr<ComingPlan> wanted(const ShowState& state) = 0;
  /// It plays. When this returns, the show, the plan and the rig that the run borrows have to be those of the plan.
  virtual void taken(const ShowOnWires& plays) = 0;
  /// The show no longer stands where it stood: nothing has changed.
  virtual void not_taken() = 0;
  /// The wires of `begin` go.
  virtual void end() = 0;
};

}  // namespace footlight::app
