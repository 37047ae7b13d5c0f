// SPDX-License-Identifier: Apache-2.0
#include "app/surfaces/run_desk.hpp"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <poll.h>

namespace footlight::app {
namespace {

using controller::Command;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMostUnanswered = 1024;  // the cue thread's ring is smaller: answers beyond are lost

/// Without spaces at its ends.
std::string_view trimmed(std::string_view line) {
  const auto space = [](unsigned char c) { return std::isspace(c) != 0; };
  while (!line.empty() && space(static_cast<unsigned char>(line.front()))) line.remove_prefix(1);
  while (!line.empty() && space(static_cast<unsigned char>(line.back()))) line.remove_suffix(1);
  return line;
}

std::vector<std::string> words_of(std::string_view line) {
  std::istringstream stream{std::string(line)};
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

bool is(std::string_view said, std::string_view verb) {
  return std::ranges::equal(said, verb, {}, [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
}

bool names_bars(controller::Outcome outcome) {
  using controller::Outcome;
  return outcome == Outcome::gate_open || outcome == Outcome::hold_pressed || outcome == Outcome::emergency_hold ||
         outcome == Outcome::not_ready;
}

}  // namespace

std::string_view to_text(RunEvent::Kind kind) {
  switch (kind) {
    case RunEvent::Kind::answer:
      return "answer";
    case RunEvent::Kind::moment:
      return "moment";
    case RunEvent::Kind::reset:
      return "reset";
    case RunEvent::Kind::alarm:
      return "alarm";
    case RunEvent::Kind::note:
      return "note";
  }
  return "";
}

std::string json_of(const RunEvent& event) {
  constexpr auto kReplace = nlohmann::ordered_json::error_handler_t::replace;  // whatever somebody typed
  Json document{{to_text(event.kind), event.text}};
  if (event.kind == RunEvent::Kind::answer) {
    document["answer"] = {
        {"order", event.order}, {"who", event.who.name}, {"refused", event.refused}, {"text", event.text}};
  }
  return document.dump(-1, ' ', false, kReplace);
}

void RunDesk::add(Verb verb) { verbs_.push_back(std::move(verb)); }

std::string RunDesk::help() const {
  std::string text(kOrders);
  for (const Verb& verb : verbs_) text += verb.help;
  return text;
}

void RunDesk::say(std::string_view line, const Speaker& who) {
  line = trimmed(line);
  std::vector<std::string> words = words_of(line);
  const auto verb =
      std::ranges::find_if(verbs_, [&](const Verb& one) { return !words.empty() && is(words[0], one.word); });
  if (verb != verbs_.end()) {
    words.erase(words.begin());
    auto answer = verb->carry_out(words, who);
    if (!answer) return refuse(line, who, std::move(answer).error().message);
    RunEvent event{RunEvent::Kind::answer, std::move(answer).value()};
    event.order = line;
    event.who = who;
    return tell(std::move(event));
  }
  const auto order = orders_.from(line);
  if (!order) return refuse(line, who, order.error().message);
  if (order->kind == Order::Kind::quit) {
    wishes_.ends = true;
    return;
  }
  say(order->command, line.empty() ? "go" : std::string(line), who);
}

void RunDesk::say(Command command, std::string order, const Speaker& who) {
  command.source = who.input;
  command.input = number_of(who);
  command.said = ++last_;
  said_[last_] = {std::move(order), who};
  if (said_.size() > kMostUnanswered) said_.erase(said_.begin());
  wishes_.commands.push_back(command);
}

void RunDesk::refuse(std::string_view order, const Speaker& who, std::string why) {
  RunEvent event{RunEvent::Kind::answer, std::move(why)};
  event.order = order;
  event.who = who;
  event.refused = true;
  tell(std::move(event));
}

void RunDesk::tell(RunEvent event) {
  if (event.at == Instant{}) event.at = now_;
  for (Surface* surface : surfaces_) surface->told(event);
}

/// For the GO guard: the first that speak get numbers of their own.
std::uint8_t RunDesk::number_of(const Speaker& who) {
  constexpr std::size_t kLast = controller::kMostGoInputs - 1;
  const auto known = std::ranges::find(inputs_, who.name);
  const auto number = static_cast<std::size_t>(known - inputs_.begin());
  if (known == inputs_.end() && inputs_.size() < kLast) inputs_.push_back(who.name);
  return static_cast<std::uint8_t>(std::min(number, kLast));
}

void RunDesk::tell_switched_off(std::uint64_t inputs) {
  const std::uint64_t fresh = inputs & ~std::exchange(off_, inputs);
  for (std::size_t i = 0; i < controller::kMostGoInputs; ++i) {
    if (((fresh >> i) & 1U) == 0) continue;
    tell(
        {RunEvent::Kind::alarm, (i < inputs_.size() ? inputs_[i] : "an input") +
                                    " has pressed GO for more than 5 s and is switched off until somebody says ok; the "
                                    "others count"});
  }
}

void RunDesk::plan_taken() {
  orders_.plan_taken();
  for (Surface* surface : surfaces_) surface->plan_taken();
}

DeskWishes RunDesk::look(const DeskView& view) {
  now_ = view.show.at;
  DeskView seen = view;
  for (const Facts& facts : facts_) facts(seen);
  against_ = seen.against;
  limits_ = seen.limits;
  cue_ = view.show.active >= 0 ? view.show.active : view.show.standby;
  tell_switched_off(view.show.inputs_off);
  for (Surface* surface : surfaces_) surface->look(seen, *this);
  wishes_.nobody = std::ranges::none_of(surfaces_, &Surface::listens);
  const controller::Bars bars = wishes_.bars;
  DeskWishes wishes = std::exchange(wishes_, {});
  wishes_.bars = bars;
  return wishes;
}

void RunDesk::answered(const Answer& answer) {
  const auto said = said_.find(answer.command.said);
  if (said == said_.end()) return;  // nobody said it: the show's own
  RunEvent event{RunEvent::Kind::answer, std::string(controller::to_text(answer.outcome)), answer.at};
  event.order = std::move(said->second.order);
  event.who = std::move(said->second.who);
  event.refused = refused(answer.outcome);
  if (names_bars(answer.outcome)) {
    for (std::size_t i = 0; i < against_.size(); ++i) event.text += (i == 0 ? ": " : ", ") + against_[i];
  }
  const bool known = limits_ != nullptr && cue_ >= 0 && static_cast<std::size_t>(cue_) < limits_->size();
  if (known && answer.command.kind == Command::Kind::tempo && !event.refused) {
    const controller::TempoLimit& most = (*limits_)[static_cast<std::size_t>(cue_)];
    if (answer.command.percent > most.percent) event.text = fmt::format("at most {} %: {}", most.percent, most.because);
  }
  said_.erase(said);
  tell(std::move(event));
}

void RunDesk::wait(Duration most) const {
  std::vector<pollfd> files;
  for (const Surface* surface : surfaces_) {
    if (surface->file() >= 0) files.push_back({surface->file(), POLLIN, 0});
  }
  (void)::poll(files.data(), files.size(),
               static_cast<int>(std::chrono::duration_cast<std::chrono::milliseconds>(most).count()));
}

}  // namespace footlight::app
