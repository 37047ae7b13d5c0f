// SPDX-License-Identifier: Apache-2.0
#include "app/remote/remote_call.hpp"

#include <algorithm>
#include <cctype>
#include <utility>

#include <fmt/format.h>

namespace footlight::app {
namespace {

using Phase = controller::Rehearsal::Phase;
using ResetState = controller::Rehearsal::ResetState;

bool is_held(const ShowState& show) {
  return show.phase == Phase::reset_held || (show.phase == Phase::stands && show.active >= 0);
}

std::string trimmed(const std::string& text) {
  const auto is_space = [](unsigned char c) { return std::isspace(c) != 0; };
  const auto begin = std::find_if_not(text.begin(), text.end(), is_space);
  const auto end = std::find_if_not(text.rbegin(), std::make_reverse_iterator(begin), is_space).base();
  return {begin, end};
}

bool is_quit(const std::string& words) {
  return std::ranges::equal(words, std::string_view("quit"), {},
                            [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
}

Result<std::string> start(const std::string& text, const DeskView& view,
                          const std::vector<controller::CuePlay>& plays) {
  const auto number = CueNumber::parse(text);
  std::string all;
  for (std::size_t c = 0; c < plays.size(); ++c) {
    all += (all.empty() ? "" : ", ") + plays[c].cue.number.to_text();
    if (number != plays[c].cue.number) continue;
    const bool standby = view.show.standby == static_cast<int>(c);
    const bool waits = view.show.phase == Phase::stands && view.show.active < 0;
    if (standby && waits && view.show.reset.state == ResetState::none) return std::string("go");
    if (standby) return input_error("cue " + text + " is standby, but the show does not wait for it");
    const std::string next =
        view.show.standby < 0 ? "none" : plays[static_cast<std::size_t>(view.show.standby)].cue.number.to_text();
    return input_error(fmt::format("cue {} is not standby ({} is): load it, then people have a way there", text, next));
  }
  return input_error(fmt::format("no cue \"{}\" (there are {})", text, all));
}

}  // namespace

Result<std::string> words_of(const RemoteCall& call, const DeskView& view,
                             const std::vector<controller::CuePlay>& plays) {
  switch (call.kind) {
    case RemoteCall::Kind::go:
      return std::string("go");
    case RemoteCall::Kind::hold:
      return std::string("hold");
    case RemoteCall::Kind::resume:
      if (!is_held(view.show)) return input_error("nothing is held");
      return std::string("go");
    case RemoteCall::Kind::start_cue:
      return start(call.text, view, plays);
    case RemoteCall::Kind::load_cue:
      return "jump cue " + call.text;
    case RemoteCall::Kind::top:
      return std::string("top");
    case RemoteCall::Kind::order: {
      std::string words = trimmed(call.text);
      if (is_quit(words)) return input_error("a run is ended at its desk");
      return words;
    }
  }
  return std::string();
}

RunEvent refusal_of(std::string order, Speaker who, std::string why) {
  RunEvent event{RunEvent::Kind::answer, std::move(why)};
  event.order = std::move(order);
  event.who = std::move(who);
  event.refused = true;
  return event;
}

}  // namespace footlight::app
