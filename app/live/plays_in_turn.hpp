// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "app/live/bus_thread.hpp"
#include "app/live/coming_plan.hpp"
#include "app/live/cue_thread.hpp"
#include "controller/rehearsal.hpp"

namespace footlight::app {

/// The plans of a run, one after the other. No thread stops for a change and no port is opened anew: the cue thread
/// goes over between two of its steps, each bus as soon as its driver has finished what is under way, and nothing of
/// the plan before is taken away until all have. Called by one thread.
class PlaysInTurn {
 public:
  using Buses = std::vector<std::unique_ptr<BusThread>>;
  /// All switches of a plan that is over, and what each bus noted of them.
  using Over = std::function<void(std::size_t switches,
                                  const std::function<const std::vector<SwitchTimes>&(std::size_t bus)>& times)>;

  /// Borrows all. @param wires of the first plan; its drivers and loops are those of the run
  PlaysInTurn(ShowOnWires& wires, const TempoMap& tempo, controller::Stands stands,
              const controller::Rehearsal::Settings& settings);
  ~PlaysInTurn();

  /// Of the plan that plays.
  [[nodiscard]] ShowOnWires& show() const;
  [[nodiscard]] controller::Rehearsal& rehearsal() const;
  [[nodiscard]] std::uint32_t number() const;
  /// How people came to it; null: they stood there.
  [[nodiscard]] std::shared_ptr<const Plan> way() const;

  /// @return true when another plan plays from now on, and `changes` has to be told  @param state of the plan that
  /// plays
  bool look(PlanChanges& changes, const ShowState& state, CueThread& cue, const Buses& buses, const Over& over);

 private:
  struct Playing;
  void go_over_to(std::unique_ptr<ComingPlan> coming, CueThread& cue, const Buses& buses);
  [[nodiscard]] std::unique_ptr<controller::Rehearsal> rehearsal_of(ShowOnWires& show, const TempoMap& tempo,
                                                                    controller::Stands stands) const;

  ShowOnWires& wires_;
  controller::Rehearsal::Settings settings_;
  std::unique_ptr<Playing> playing_;
  std::unique_ptr<Playing> next_;    ///< the cue thread has been asked to go over to it
  std::unique_ptr<Playing> before_;  ///< a bus may still play it
  bool gone_over_ = false;           ///< the cue thread plays `next_`
};

}  // namespace footlight::app
