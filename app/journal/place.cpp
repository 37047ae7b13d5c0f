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

Place place_of(const ShowState& state, Duration machine_ahead) {
  using Phase = controller::Rehearsal::Phase;
  Place place;
  place.at = state.at.time_since_epoch() + machine_ahead;
  place.where = state.where;
  if (place.where.runs_since) *place.where.runs_since += machine_ahead;
  place.over = state.phase == Phase::finished;
  place.in_reset = state.phase == Phase::resets || state.phase == Phase::reset_held;
  return place;
}

TakeUp take_up(const Place& place, Duration now, AfterDeath policy, const std::vector<controller::CuePlay>& plays) {
  TakeUp out{place.where, {}};
  const Duration gap = std::max(Duration{}, now - place.at);
  const std::string silent = fmt::format("{:.2f} s", to_seconds(gap));
  if (!place.where.runs_since) {
    out.told = place.in_reset ? "cut off in a reset move, " + silent + " ago: its end is lit, at " +
                                    cue_text(out.where, plays) + "; see that people are there before GO"
                              : "cut off " + silent + " ago, while the show stood at " + cue_text(out.where, plays) +
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
  if (ran <= Duration{} && out.where.waits) {
    out.where.cue.reset();  // it had not begun
  } else {
    out.where.position += Duration(std::max(Duration{}, ran).count() / 100 * out.where.percent);
    if (ran > Duration{}) out.where.waits = false;
    if (out.where.cue && *out.where.cue < plays.size()) {
      out.where.position = std::min(out.where.position, plays[*out.where.cue].to);
    }
  }
  out.where.runs_since.reset();
  out.told =
      fmt::format("cut off {} ago, in the middle of a cue: it stands at {}{}; see where people are before GO", silent,
                  cue_text(out.where, plays), gap > kLongestGap ? ", for the markers have lost guidance since" : "");
  return out;
}

Whereabouts by_clock(Whereabouts where, Instant clock, Duration machine) {
  if (where.runs_since) where.runs_since = clock + (where.runs_since->time_since_epoch() - machine);
  return where;
}

}  // namespace footlight::app
