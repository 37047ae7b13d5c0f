// SPDX-License-Identifier: Apache-2.0
#include "controller/cue_list.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "core/check.hpp"

namespace footlight::controller {
namespace {

std::vector<Cue> cues_of(const Show& show, const Plan& plan) {
  if (!show.cues.empty()) return show.cues;
  std::vector<Cue> cues;
  for (std::size_t s = 0; s < plan.sections.size(); ++s) {
    Cue cue;
    cue.number = CueNumber::parse(std::to_string(s + 1)).value();
    cue.name = plan.sections[s].name;
    cue.section = SectionIndex::of(s);
    cue.continue_mode = ContinueMode::auto_follow;
    cues.push_back(std::move(cue));
  }
  return cues;
}

std::optional<Duration> gap_between(const CuePlay& play, const Cue& next) {
  switch (play.cue.continue_mode) {
    case ContinueMode::manual:
      return std::nullopt;
    case ContinueMode::auto_continue:
      return std::max(Duration{}, play.cue.post_wait - (play.to - play.from)) + next.pre_wait;
    case ContinueMode::auto_follow:
      return play.cue.post_wait + next.pre_wait;
  }
  return std::nullopt;
}

}  // namespace

std::vector<CuePlay> cue_plays(const Show& show, const Plan& plan) {
  FL_CHECK(!plan.tracks.empty() && !plan.tracks.front().empty());
  const std::vector<Cue> cues = cues_of(show, plan);
  std::vector<CuePlay> plays;
  Instant from = plan.tracks.front().front().time;
  const Instant last = plan.tracks.front().back().time;
  for (std::size_t c = 0; c < cues.size(); ++c) {
    FL_CHECK(c == 0 || cues[c - 1].section < cues[c].section);
    const Instant end = c + 1 == cues.size() ? last : plan.sections.at(cues[c].section.at()).end;
    plays.push_back({cues[c], from, std::max(from, end), std::nullopt});
    from = plays.back().to;
  }
  for (std::size_t c = 0; c + 1 < plays.size(); ++c) plays[c].gap_after = gap_between(plays[c], plays[c + 1].cue);
  return plays;
}

}  // namespace footlight::controller
