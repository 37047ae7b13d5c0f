// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "controller/bus_loop.hpp"
#include "controller/cue_engine.hpp"
#include "controller/cue_list.hpp"
#include "controller/cue_schedule.hpp"
#include "controller/tempo_limit.hpp"
#include "core/plan.hpp"
#include "core/result.hpp"
#include "core/rig.hpp"
#include "core/show.hpp"
#include "drivers/driver.hpp"

namespace footlight::app {

/// Everything that plays a show, put together, for virtual and for real time alike: who drives it steps engine and
/// loops. Its parts borrow each other.
struct ShowOnWires {
  std::vector<std::unique_ptr<drivers::Driver>> drivers;  ///< one for each bus of the rig, as the loops
  std::vector<controller::CuePlay> plays;
  std::optional<controller::CueSchedule> schedule;
  std::vector<std::unique_ptr<controller::BusLoop>> loops;
  std::optional<controller::CueEngine> engine;
  Duration opening{};      ///< time for the roll call, at which nodes may be silent; the opening is lit meanwhile
  Duration latch_ahead{};  ///< so long before its instant the first bus hands over a latch
};

/// Show time that the cues play, with the shortest stand where the show waits for GO.
[[nodiscard]] Duration run_length(const std::vector<controller::CuePlay>& plays);

/// @param mutes groups may be muted while it plays: one look more, where the markers take it
/// Errors: a plan that is not valid and whatever build_schedule refuses.
[[nodiscard]] Result<std::unique_ptr<ShowOnWires>> put_on_wires(const Show& show, const Plan& plan, const Rig& rig,
                                                                std::vector<std::unique_ptr<drivers::Driver>> drivers,
                                                                bool mutes = false);

/// Lets no cue run faster than its walks are proved for and its buses can follow. @param wires drivers of `show`
std::vector<controller::TempoLimit> limit_tempo(const Show& content, const Plan& plan, const Rig& rig,
                                                ShowOnWires& show, const ShowOnWires& wires);

/// Another plan for the wires of a show that plays: plays, schedule and engine, and neither drivers nor loops. Its
/// looks are numbered for markers that show those of `before`.
/// @param wires drivers and loops of the show that plays: asked for budgets, beside their threads
/// Errors: as put_on_wires, and more looks than the markers hold. Any thread.
[[nodiscard]] Result<std::unique_ptr<ShowOnWires>> put_beside(const Show& show, const Plan& plan, const Rig& rig,
                                                              const ShowOnWires& wires,
                                                              const controller::CueSchedule& before);

/// Presses GO whenever the show waits: at first when it is told, then after the shortest stand.
class GoWhenWaiting {
 public:
  /// @param first kNever: not yet
  explicit GoWhenWaiting(Instant first = kNever) : at_(first) {}
  /// @return true when GO is to be pressed now
  bool due(const controller::CueEngine& engine, Instant now) noexcept;
  /// Presses it. @return true when it has
  bool step(controller::CueEngine& engine, Instant now) noexcept;
  /// When it will press, by what is known now.
  [[nodiscard]] Instant next() const noexcept { return at_; }

 private:
  Instant at_;
};

}  // namespace footlight::app
