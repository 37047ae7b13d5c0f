// SPDX-License-Identifier: Apache-2.0
#include "app/rehearsing/pace_orders.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

namespace footlight::app {
namespace {

using Phase = controller::Rehearsal::Phase;
using ResetState = controller::Rehearsal::ResetState;

}  // namespace

void PaceOrders::add_to(RunDesk& desk) {
  desk_ = &desk;
  desk.add(*this);
  const auto& plays = desk.orders().plays();
  desk.add([&plays](DeskView& view) {
    const bool waits = view.show.phase == Phase::stands && view.show.active < 0 && view.show.standby >= 0;
    if (waits) view.standby_notes = plays[static_cast<std::size_t>(view.show.standby)].cue.notes;
  });
  desk.add(RunDesk::Verb{"tap", "tap                          the tempo, by tapping it three times and more\n",
                         [this](const std::vector<std::string>& words, const Speaker& who) -> Result<std::string> {
                           if (!words.empty()) return input_error("tap: nothing is wanted after it");
                           return tap(who);
                         }});
  desk.add(RunDesk::Verb{
      "standby", "standby 12; standby up, down the cue that GO starts; people are sent to its beginning\n",
      [this](const std::vector<std::string>& words, const Speaker& who) { return standby(words, who); }});
}

void PaceOrders::look(const DeskView& view, RunDesk& /*desk*/) { seen_ = view.show; }

Result<std::string> PaceOrders::tap(const Speaker& who) {
  const auto bpm = taps_.tap(clock_.now());
  if (!bpm) return fmt::format("tap {}", taps_.taps());
  const double written = show_.tempo.bpm_at(show_.tempo.count_at(seen_.position));
  const double wanted = std::round(*bpm / written * 100);
  const int percent = static_cast<int>(std::clamp(wanted, static_cast<double>(controller::kSlowest_percent),
                                                  static_cast<double>(controller::kFastest_percent)));
  controller::Command command;
  command.kind = controller::Command::Kind::tempo;
  command.percent = percent;
  desk_->say(command, fmt::format("tempo {}", percent), who);
  return fmt::format("tap {}: {:.0f} counts a minute, {} % of the written tempo", taps_.taps(), *bpm, percent);
}

Result<std::string> PaceOrders::standby(const std::vector<std::string>& words, const Speaker& who) {
  const auto& plays = desk_->orders().plays();
  const auto last = static_cast<int>(plays.size()) - 1;
  if (seen_.phase != Phase::stands && seen_.phase != Phase::finished) {
    return input_error("standby: the show runs (\"jump cue 12\" stops it at the end of the set)");
  }
  // Of a jump that waits for its GO, the cue that it leads to.
  int now = seen_.standby < 0 ? last + 1 : seen_.standby;
  if (seen_.reset.state != ResetState::none) {
    const auto cue = std::ranges::find_if(plays, [&](const auto& play) { return seen_.reset.to < play.to; });
    now = static_cast<int>(cue - plays.begin());
  } else if (seen_.active >= 0) {
    now = seen_.active;
  }
  const std::string which = words.size() == 1 ? words[0] : words.size() == 2 && words[0] == "cue" ? words[1] : "";
  int wanted = 0;
  if (which == "up" || which == "down") {
    wanted = now + (which == "down" ? 1 : -1);
    if (wanted < 0 || wanted > last) {
      return input_error(wanted < 0 ? "standby: this is the first cue" : "standby: there is no later cue");
    }
  } else {
    const auto number = CueNumber::parse(which);
    const auto cue = std::ranges::find_if(plays, [&](const auto& play) { return number == play.cue.number; });
    if (cue == plays.end()) {
      return input_error(fmt::format("standby: no cue \"{}\" (a number, up or down is wanted)", which));
    }
    wanted = static_cast<int>(cue - plays.begin());
  }
  const Cue& cue = plays[static_cast<std::size_t>(wanted)].cue;
  controller::Command command;
  command.kind = controller::Command::Kind::jump;
  command.position = plays[static_cast<std::size_t>(wanted)].from;
  desk_->say(command, "jump cue " + cue.number.to_text(), who);
  const std::string notes = cue.notes.empty() ? "" : ": " + cue.notes;
  return fmt::format("standby cue {}{}{}", cue.number.to_text(), cue.name.empty() ? "" : " " + cue.name, notes);
}

}  // namespace footlight::app
