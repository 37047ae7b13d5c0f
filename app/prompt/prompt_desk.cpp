// SPDX-License-Identifier: Apache-2.0
#include "app/prompt/prompt_desk.hpp"

#include <array>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace footlight::app {
namespace {

using controller::Command;
using controller::Outcome;
using Json = nlohmann::ordered_json;
using Kind = Command::Kind;
using Phase = controller::Rehearsal::Phase;

constexpr Duration kStateLines = milliseconds(500);  // while nothing but the position changes
constexpr Duration kRefusedFor = milliseconds(2500);
constexpr int kTempoStep_percent = 5;
constexpr char kEscape = 27;

constexpr std::string_view kKeys =
    "Space GO   h HOLD (freeze)   e HOLD at the end of the set (again: run on)   b back   t top   j jump   l loop\n"
    "+ - tempo  n one count   p people are placed   c cancel the jump   a acknowledge   q q quit   ? this\n"
    "HOLD is no emergency stop: it changes lamps, and people have to see them. Somebody must watch the stage.\n";

std::string_view name_of(Kind kind) {
  constexpr std::array<std::string_view, 15> kNames{"go",
                                                    "hold",
                                                    "hold end",
                                                    "run on",
                                                    "back",
                                                    "jump",
                                                    "loop",
                                                    "loop off",
                                                    "tempo",
                                                    "step",
                                                    "reset is planned",
                                                    "reset is impossible",
                                                    "placed",
                                                    "cancel",
                                                    "ok"};
  return kNames.at(static_cast<std::size_t>(kind));
}

bool by_people(Kind kind) { return kind != Kind::reset_planned && kind != Kind::reset_impossible; }

}  // namespace

PromptDesk::PromptDesk(Session& session, const Show& show, const Plan& plan, bool json, bool listens)
    : session_(session),
      orders_(show, plan),
      text_(show, plan, orders_.plays()),
      json_(json),
      input_(listens ? STDIN_FILENO : -1),
      keys_(listens && RawTerminal::there()) {
  if (!keys_) return;
  terminal_.emplace();
  if (!session.quiet) session_.note(std::string(kKeys));
}

DeskWishes PromptDesk::look(const DeskView& view) {
  seen_ = view;
  wishes_ = {};
  if (!input_.closed()) read();
  wishes_.nobody = input_.closed();
  show_state(view);
  return std::exchange(wishes_, {});
}

void PromptDesk::read() {
  if (keys_) {
    for (const char key : input_.take()) take_key(key);
  } else {
    for (const std::string& line : input_.lines()) take_line(line);
  }
  if (input_.closed()) {
    session_.note("stdin is closed: nobody can press GO any more (--go presses it; SIGINT ends)");
  }
}

void PromptDesk::take_line(const std::string& line) {
  auto order = orders_.from(line);
  if (!order) return refuse(order.error().message);
  switch (order->kind) {
    case Order::Kind::command:
      order->command.source = keys_ ? controller::GoSource::keyboard : controller::GoSource::lines;
      wishes_.commands.push_back(order->command);
      return;
    case Order::Kind::help:
      return tell("help", std::string(kOrders));
    case Order::Kind::state:
      return json_ ? session_.print_now(text_.json(seen_)) : session_.print_now(text_.line(seen_));
    case Order::Kind::quit:
      wishes_.ends = true;
      return;
  }
}

void PromptDesk::order(Kind kind, int percent) {
  Command command;
  command.kind = kind;
  command.source = controller::GoSource::keyboard;
  command.percent = percent;
  wishes_.commands.push_back(command);
}

void PromptDesk::take_key(char key) {
  if (prompt_) return type(key);
  const bool quits = key == 'q' && std::exchange(quit_asked_, key == 'q');
  quit_asked_ = key == 'q';
  switch (key) {
    case ' ':
      return order(Kind::go);
    case 'h':
      return order(Kind::hold);
    case 'e':
      return order(seen_.show.holds_at_end ? Kind::run_on : Kind::hold_at_end);
    case 'b':
      return order(Kind::back);
    case 't':
      return take_line("top");
    case 'j':
      return ask("jump ");
    case 'l':
      return seen_.show.loops ? order(Kind::loop_off) : ask("loop ");
    case '+':
    case '=':
      return order(Kind::tempo, seen_.show.percent + kTempoStep_percent);
    case '-':
      return order(Kind::tempo, seen_.show.percent - kTempoStep_percent);
    case 'n':
      return order(Kind::step);
    case 'p':
      return order(Kind::placed);
    case 'c':
      return order(Kind::cancel);
    case 'a':
      return order(Kind::acknowledge);
    case '?':
      return session_.note(std::string(kKeys));
    case 'q':
      if (quits) {
        wishes_.ends = true;
      } else {
        refuse("q again ends the run; no lamp is made dark");
      }
      return;
    default:
      return refuse("? tells the keys");
  }
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

void PromptDesk::answered(const Answer& answer) {
  const Command& command = answer.command;
  if (!by_people(command.kind)) return;
  const std::string text(controller::to_text(answer.outcome));
  if (json_) {
    session_.print_now(
        Json{{"answer", {{"order", name_of(command.kind)}, {"refused", refused(answer.outcome)}, {"text", text}}}}
            .dump());
    return;
  }
  if (refused(answer.outcome)) return refuse(fmt::format("{} refused: {}", name_of(command.kind), text));
  if (answer.outcome != Outcome::done) return tell("answer", fmt::format("{}: {}", name_of(command.kind), text));
  if (command.kind == Kind::hold) tell("answer", "HOLD. It is no emergency stop: watch the stage");
}

void PromptDesk::refuse(const std::string& why) {
  if (keys_) {
    refused_ = "\a" + why;
    refused_until_ = seen_.show.at + kRefusedFor;
  } else if (json_) {
    session_.print_now(Json{{"answer", {{"refused", true}, {"text", why}}}}.dump());
  } else {
    session_.note(why);
  }
}

void PromptDesk::tell(std::string_view what, const std::string& line) {
  if (json_) return session_.print_now(Json{{what, line}}.dump());
  if (session_.json) return;  // the report alone
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
  std::string now = fmt::format("{} {} {} {} {} {} {} {} {}", static_cast<int>(state.phase), state.reset.id,
                                static_cast<int>(state.reset.state), state.active, state.standby, state.percent,
                                state.target.current, state.holds_at_end, view.roll_called);
  for (const BusView& bus : view.buses) now += fmt::format(" {}", bus.unconfirmed);
  const bool runs = state.phase != Phase::stands && state.phase != Phase::finished;
  if (now == told_ && (!runs || (told_at_ != Instant::min() && state.at - told_at_ < kStateLines))) return;
  told_ = now;
  told_at_ = state.at;
  session_.print_now(text_.json(view));
}

}  // namespace footlight::app
