// SPDX-License-Identifier: Apache-2.0
#include "app/edit/same_place.hpp"

#include <algorithm>

namespace footlight::app {
namespace {

const controller::CuePlay& play_of(const CueNumber& number, const std::vector<controller::CuePlay>& plays) {
  const controller::CuePlay* found = &plays.front();
  for (const controller::CuePlay& play : plays) {
    if (play.cue.number <= number) found = &play;
  }
  return *found;
}

}  // namespace

Instant same_place(const Plan& before, const std::vector<controller::CuePlay>& plays_before, const Plan& now,
                   const std::vector<controller::CuePlay>& plays, const controller::Stands& stands, Instant position,
                   int active, int standby) {
  if (active < 0 && standby < 0) return plays.back().to;
  if (active < 0) {
    const CueNumber& number = plays_before[static_cast<std::size_t>(standby)].cue.number;
    const controller::CuePlay& play = play_of(number, plays);
    return play.cue.number == number ? play.from : play.to;
  }
  const auto old = std::ranges::find_if(before.sections, [&](const PlanSection& one) { return position <= one.end; });
  const auto same = old == before.sections.end() ? now.sections.end()
                                                 : std::ranges::find(now.sections, old->name, &PlanSection::name);
  if (same == now.sections.end()) return play_of(plays_before[static_cast<std::size_t>(active)].cue.number, plays).from;
  // From its end where people stand there: a longer section holds its last picture longer.
  const Instant there = position == old->end ? same->end : std::min(same->start + (position - old->start), same->end);
  return std::clamp(stands.until(there), plays.front().from, plays.back().to);
}

}  // namespace footlight::app
