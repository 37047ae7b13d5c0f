// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/live/cue_thread.hpp"
#include "app/live/live_run.hpp"
#include "controller/cue_list.hpp"
#include "controller/rehearsal.hpp"
#include "core/result.hpp"

namespace footlight::app {

/// Where a show was, in the machine's own time: what another program on this machine needs to take it up.
struct Place {
  controller::Rehearsal::Whereabouts where{};  ///< `runs_since` is of `machine_time`
  Duration at{};                               ///< of `machine_time`, when this was so
  bool over = false;                           ///< the last cue had been played
  bool in_reset = false;                       ///< a reset move was under way: `where` is its end
  controller::Chase::Word time{};              ///< of the source of time
  bool emergency_hold = false;                 ///< that nobody had acknowledged
  std::string readiness{};                     ///< as Readiness::outlives; empty: nobody knows

  friend bool operator==(const Place&, const Place&) = default;
};

/// @param machine_ahead of the clock in which the state tells its instants
[[nodiscard]] Place place_of(const DeskView& view, Duration machine_ahead);

/// Without a sign of life for so long, no marker guides any more (docs/wire-protocol.md, lease): people have stopped.
inline constexpr Duration kLongestGap = milliseconds(2500);

/// What is done with a running show that was cut off.
enum class AfterDeath {
  go_on,  ///< as if nothing had happened, while the markers still guide; else it stands
  stand,  ///< it stands where it was
};

/// How a show goes on that was cut off.
struct TakeUp {
  TakenUp show{};    ///< `runs_since` is of `machine_time`
  std::string told;  ///< for the operator: where people are taken to be, and why
};

/// A show that stood, stands; nobody is moved. One that ran goes on in time where the gap is short enough, because the
/// music plays on and people walk on; else it stands where it was cut off, and GO goes on: a source of time begins
/// nothing then before somebody has seen where people are.
/// @param now of `machine_time`
[[nodiscard]] TakeUp take_up(const Place& place, Duration now, AfterDeath policy,
                             const std::vector<controller::CuePlay>& plays);

/// The same by another clock that reads `clock` when `machine_time` reads `machine`.
[[nodiscard]] TakenUp by_clock(TakenUp show, Instant clock, Duration machine);

}  // namespace footlight::app
