// SPDX-License-Identifier: Apache-2.0
#include "app/journal/place.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace footlight::app {
namespace {

using Whereabouts = controller::Rehearsal::Whereabouts;

std::string cue_text(const Whereabouts& where, const std::vector<controller::CuePlay>& plays) {
  if (!where.cue || *where.cue >= plays.size()) return fmt::format("{:.3f} s", to_seconds(where.position));
  return fmt::format("{:.3f} s, in cue {}", to_seconds(where.position), plays[*where.cue].cue.number.to_text());
}

}  // namespace

Place place_of(const DeskView& view, Duration machine_ahead) {
  using Phase = controller::Rehearsal::Phase;
  const ShowState& state = view.show;
  Place place;
  place.at = state.at.time_since_epoch() + machine_ahead;
  place.where = state.where;
  if (place.where.runs_since) *place.where.runs_since += machine_ahead;
  place.over = state.phase == Phase::finished;
  place.in_reset = state.phase == Phase::resets || state.phase == Phase::reset_held;
  place.time = {state.time.on, state.time.armed};
  place.emergency_hold = view.emergency_hold;
  place.readiness = view.readiness.outlives;
  return place;
}

TakeUp take_up(const Place& place, Duration now, AfterDeath policy, const std::vector<controller::CuePlay>& plays) {
  TakeUp out{{place.where, place.time}, {}};
  auto& where = out.show.where;
  const Duration gap = std::max(Duration{}, now - place.at);
  const std::string silent = fmt::format("{:.2f} s", to_seconds(gap));
  if (!place.where.runs_since) {
    if (place.in_reset) out.show.time.armed = false;
    out.told = place.in_reset ? "cut off in a reset move, " + silent + " ago: its end is lit, at " +
                                    cue_text(where, plays) + "; see that people are there before GO"
                              : "cut off " + silent + " ago, while the show stood at " + cue_text(where, plays) +
                                    ": it stands there";
    return out;
  }
  if (policy == AfterDeath::go_on && gap <= kLongestGap) {
    out.told = fmt::format("cut off {} ago, in the middle of a cue: the show goes on in time", silent);
    return out;
  }
  // Nobody knows when it died after its last sign of life: its last known place it is.
  const Instant since = *place.where.runs_since;
  const Duration ran = place.at - since.time_since_epoch();
  if (ran <= Duration{} && where.waits) {
    where.cue.reset();  // it had not begun
  } else {
    where.position += Duration(std::max(Duration{}, ran).count() / 100 * where.percent);
    if (ran > Duration{}) where.waits = false;
    if (where.cue && *where.cue < plays.size()) {
      where.position = std::min(where.position, plays[*where.cue].to);
    }
  }
  where.runs_since.reset();
  out.show.time.armed = false;
  out.told =
      fmt::format("cut off {} ago, in the middle of a cue: it stands at {}{}; see where people are before GO", silent,
                  cue_text(where, plays), gap > kLongestGap ? ", for the markers have lost guidance since" : "");
  return out;
}

TakenUp by_clock(TakenUp show, Instant clock, Duration machine) {
  auto& since = show.where.runs_since;
  if (since) since = clock + (since->time_since_epoch() - machine);
  return show;
}

}  // namespace footlight::app
