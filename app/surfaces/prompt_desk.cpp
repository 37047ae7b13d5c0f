// SPDX-License-Identifier: Apache-2.0
#include "app/surfaces/prompt_desk.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/speaking.hpp"

namespace footlight::app {
namespace {

using Json = nlohmann::ordered_json;
using Phase = controller::Rehearsal::Phase;

constexpr Duration kStateLines = milliseconds(500);  // while nothing but the position changes
constexpr Duration kRefusedFor = milliseconds(2500);
constexpr int kTempoStep_percent = 5;
constexpr char kEscape = 27;
// Those that keys send in this place (Ctrl-Q, Ctrl-R) are nobody's.
constexpr char kUp = 17;
constexpr char kDown = 18;

constexpr std::string_view kKeys =
    "Space GO   h HOLD (freeze)   e HOLD at the end of the set (again: run on)   b back   t top   j jump   l loop\n"
    "+ - . tempo, tapped   s one count   p people are placed   c cancel the jump   up down standby   o solo   m mute\n"
    "n note   a acknowledge   q q quit   ? this\n"
    "HOLD is no emergency stop: it changes lamps, and people have to see them. Somebody must watch the stage.\n";

}  // namespace

PromptDesk::PromptDesk(Session& session, const Show& show, const Plan& plan, RunDesk& desk, bool json, bool listens)
    : session_(session),
      desk_(desk),
      text_(show, plan, desk.orders().plays()),
      json_(json),
      input_(listens ? STDIN_FILENO : -1),
      keys_(listens && RawTerminal::there()) {
  if (!keys_) return;
  me_ = {controller::GoSource::keyboard, "keyboard"};
  terminal_.emplace();
  if (!session.quiet) session_.note(std::string(kKeys));
}

void PromptDesk::look(const DeskView& view, RunDesk& /*desk*/) {
  seen_ = view;
  if (!input_.closed()) read();
  tell_lost();
  show_state(view);
}

/// Arrow keys as one byte each; other sequences of a terminal are nobody's.
std::string PromptDesk::without_arrows(const std::string& keys) {
  std::string out;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (keys[i] == kUp || keys[i] == kDown) continue;
    if (keys[i] != kEscape || i + 1 >= keys.size() || keys[i + 1] != '[') {
      out += keys[i];
      continue;
    }
    i += 2;
    while (i < keys.size() && (keys[i] < '@' || keys[i] > '~')) ++i;  // ECMA-48, 5.4: parameters, then a final byte
    if (i < keys.size() && keys[i] == 'A') out += kUp;
    if (i < keys.size() && keys[i] == 'B') out += kDown;
  }
  return out;
}

void PromptDesk::read() {
  if (keys_) {
    for (const char key : without_arrows(input_.take())) take_key(key);
  } else {
    for (const std::string& line : input_.lines()) take_line(line);
  }
  if (input_.closed()) {
    session_.note("stdin is closed: nobody can press GO here any more (--go presses it; SIGINT ends)");
  }
}

void PromptDesk::take_line(const std::string& line) {
  if (line == "help" || line == "?") return print(json_ ? Json{{"help", desk_.help()}}.dump() : desk_.help());
  if (line == "state") return session_.print_now(json_ ? text_.json(seen_) : text_.line(seen_));
  desk_.say(line, me_);
}

void PromptDesk::take_key(char key) {
  if (prompt_) return type(key);
  const bool quits = key == 'q' && std::exchange(quit_asked_, key == 'q');
  quit_asked_ = key == 'q';
  switch (key) {
    case ' ':
      return take_line("go");
    case 'h':
      return take_line("hold");
    case 'e':
      return take_line(seen_.show.holds_at_end ? "run on" : "hold end");
    case 'b':
      return take_line("back");
    case 't':
      return take_line("top");
    case 'j':
      return ask("jump ");
    case 'l':
      return seen_.show.loops ? take_line("loop off") : ask("loop ");
    case '+':
    case '=':
      return change_tempo(kTempoStep_percent);
    case '-':
      return change_tempo(-kTempoStep_percent);
    case 'n':
    case 'N':
      return ask("note ");
    case '.':
      return take_line("tap");
    case 'm':
      return seen_.muted.empty() ? ask("mute ") : take_line("unmute");
    case 'o':
      return seen_.muted.empty() ? ask("solo ") : take_line("solo off");
    case kUp:
      return take_line("standby up");
    case kDown:
      return take_line("standby down");
    case 's':
      return take_line("step");
    case 'p':
      return take_line("placed");
    case 'c':
      return take_line("cancel");
    case 'a':
      return take_line("ok");
    case '?':
      return session_.note(std::string(kKeys));
    case 'q':
      if (quits) {
        take_line("quit");
      } else {
        refuse("q again ends the run; no lamp is made dark");
      }
      return;
    default:
      return refuse("? tells the keys");
  }
}

void PromptDesk::change_tempo(int by_percent) {
  const int percent =
      std::clamp(seen_.show.percent + by_percent, controller::kSlowest_percent, controller::kFastest_percent);
  take_line(fmt::format("tempo {}", percent));
}

void PromptDesk::ask(std::string prefix) {
  prompt_ = std::move(prefix);
  typed_.clear();
}

void PromptDesk::type(char key) {
  constexpr char kDelete = 127;
  constexpr char kBackspace = 8;
  if (key == kEscape) {
    prompt_.reset();
  } else if (key == '\n' || key == '\r') {
    const std::string line = *std::exchange(prompt_, std::nullopt) + typed_;
    take_line(line);
  } else if (key == kDelete || key == kBackspace) {
    if (!typed_.empty()) typed_.pop_back();
  } else if (typed_.size() < 60 && key >= ' ') {
    typed_ += key;
  }
}

void PromptDesk::told(const RunEvent& event) {
  if (json_) return session_.print_now(json_of(event));
  if (event.kind == RunEvent::Kind::answer) return answered(event);
  if (event.kind == RunEvent::Kind::alarm) return session_.note("ALARM: " + event.text);
  print(event.text);
}

void PromptDesk::answered(const RunEvent& answer) {
  const bool by_others = answer.who.name != me_.name;
  const std::string said = by_others ? answer.order + ", by " + answer.who.name : answer.order;
  if (answer.refused) return refuse(fmt::format("{} refused: {}", said, answer.text));
  if (by_others || answer.text != "done") return print(fmt::format("{}: {}", said, answer.text));
  if (answer.order.starts_with("hold")) print("HOLD. It is no emergency stop: watch the stage");
}

void PromptDesk::refuse(const std::string& why) {
  if (keys_) {
    refused_ = "\a" + why;
    refused_until_ = seen_.show.at + kRefusedFor;
  } else {
    session_.note(why);
  }
}

void PromptDesk::print(const std::string& line) {
  if (session_.json && !json_) return;  // the report alone
  session_.clear_line();
  session_.print_now(line);
}

void PromptDesk::show_state(const DeskView& view) {
  const ShowState& state = view.show;
  if (keys_) {
    std::string line = prompt_ ? *prompt_ + typed_ + "_" : text_.line(view);
    if (!prompt_ && state.at < refused_until_) line = refused_ + " | " + line;
    if (refused_.starts_with('\a')) refused_.erase(0, 1);  // rings once
    return session_.show_line(line);
  }
  if (!json_) return;
  const std::string now = StateText::changes(view);
  const bool runs = state.phase != Phase::stands && state.phase != Phase::finished;
  if (now == told_ && (!runs || (told_at_ != Instant::min() && state.at - told_at_ < kStateLines))) return;
  told_ = now;
  told_at_ = state.at;
  // The next one makes it worthless: a reader that is slow gets fewer of them.
  if (!Speaking::say(stdout, text_.json(view) + "\n", WriterThread::Worth::status)) return told_.clear();
  std::fflush(stdout);
}

void PromptDesk::tell_lost() {
  const std::uint64_t lost = Speaking::lost();
  if (lost == 0) return;
  told({RunEvent::Kind::note, fmt::format("whoever reads this was too slow: {} lines are left out", lost)});
}

}  // namespace footlight::app
