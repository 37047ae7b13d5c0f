// SPDX-License-Identifier: Apache-2.0
#include "app/readiness/readiness.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "drivers/leading.hpp"

namespace footlight::app {
namespace {

constexpr std::size_t kNamed = 8;  // nodes of a message
// Of a text that outlives the program; one that is longer is another text then, and overridden no more.
constexpr std::size_t kLongestText = 300;

using Json = nlohmann::ordered_json;

bool done(Readiness::State state) {
  using State = Readiness::State;
  return state == State::success || state == State::skipped || state == State::warning;
}

/// 3290 as "3,290"
std::string grouped(std::size_t number) {
  std::string text = std::to_string(number);
  for (auto at = static_cast<std::ptrdiff_t>(text.size()) - 3; at > 0; at -= 3) {
    text.insert(static_cast<std::size_t>(at), ",");
  }
  return text;
}

}  // namespace

std::string_view to_text(Scope scope) {
  constexpr std::array<std::string_view, 4> kTexts{"none", "rehearsal", "live", "lights-only"};
  return kTexts.at(static_cast<std::size_t>(scope));
}

std::string_view to_text(Readiness::Stage stage) {
  constexpr std::array<std::string_view, Readiness::kStages> kTexts{"show",          "plan",   "buses", "roll-call",
                                                                    "plan-on-nodes", "probes", "looks", "time"};
  return kTexts.at(static_cast<std::size_t>(stage));
}

std::string_view to_text(Readiness::State state) {
  constexpr std::array<std::string_view, 7> kTexts{"OFF", "NEXT", "WAITING", "SUCCESS", "SKIPPED", "WARNING", "ERROR"};
  return kTexts.at(static_cast<std::size_t>(state));
}

Readiness::Readiness(Scope scope) : scope_(scope) {}

void Readiness::tell(Stage stage, State state, std::string text, bool lock) {
  Fact& fact = facts_.at(static_cast<std::size_t>(stage));
  if (fact.lock) return;  // for this run
  // An override waits for an answer that is still on its way.
  if (state != State::waiting && (state != State::error || text != fact.overridden)) fact.overridden_by.clear();
  fact.state = state;
  fact.text = std::move(text);
  fact.lock = lock;
}

Readiness::State Readiness::state_of(const Fact& fact) const {
  const bool overridden = !fact.overridden_by.empty() && !fact.lock && fact.text == fact.overridden;
  return fact.state == State::error && overridden ? State::warning : fact.state;
}

Result<std::string> Readiness::override_stage(std::string_view name, std::string_view who) {
  std::string all;
  for (std::size_t s = 0; s < kStages; ++s) {
    const std::string_view stage = to_text(static_cast<Stage>(s));
    all += (all.empty() ? "" : ", ") + std::string(stage);
    if (stage != name) continue;
    Fact& fact = facts_[s];
    if (fact.state != State::error) {
      return input_error(fmt::format("override: {} is {}, no ERROR", name, to_text(state_of(fact))));
    }
    if (fact.lock) return input_error(fmt::format("override: {}: {}: nobody answers for that", name, fact.text));
    fact.overridden_by = who;
    fact.overridden = fact.text;
    return fmt::format("{} is overridden by {}: {}", name, who, fact.text);
  }
  return input_error(fmt::format("override: no stage \"{}\" (there are {})", name, all));
}

bool Readiness::locked() const { return std::ranges::any_of(facts_, &Fact::lock); }

Result<std::string> Readiness::arm() {
  if (scope_ == Scope::none) return input_error("arm: the scope is none: nothing may be lit");
  std::string missing;
  for (const Report& stage : report()) {
    if (done(stage.state)) continue;
    missing += fmt::format("{}{} {}{}{}", missing.empty() ? "" : "; ", stage.name, to_text(stage.state),
                           stage.text.empty() ? "" : ": ", stage.text);
  }
  if (!missing.empty()) return input_error("arm: " + missing);
  armed_ = true;
  return std::string("GO is armed");
}

Result<std::string> Readiness::disarm() {
  if (scope_ != Scope::live) return input_error("disarm: only a run with --scope live is armed");
  armed_ = false;
  return std::string("GO is refused until somebody arms it again");
}

bool Readiness::refuses_go() const {
  if (scope_ == Scope::none) return true;
  if (scope_ == Scope::live) return !armed_;
  return locked();
}

std::vector<Readiness::Report> Readiness::report() const {
  std::vector<Report> out;
  bool reached = true;  // all before are done
  for (std::size_t s = 0; s < kStages; ++s) {
    State state = state_of(facts_[s]);
    if (state == State::off && reached && scope_ != Scope::none) state = State::next;
    out.push_back({to_text(static_cast<Stage>(s)), state, facts_[s].text,
                   !facts_[s].overridden_by.empty() && facts_[s].text == facts_[s].overridden});
    reached = reached && done(state);
  }
  return out;
}

std::vector<std::string> Readiness::against() const {
  if (!refuses_go()) return {};
  std::vector<std::string> out;
  for (const Report& stage : report()) {
    if (stage.state == State::error || stage.state == State::waiting) {
      out.push_back(fmt::format("{}: {}", stage.name, stage.text));
    }
  }
  if (out.empty()) out.emplace_back(scope_ == Scope::none ? "the scope is none" : "nobody has said arm");
  return out;
}

std::string Readiness::outlives() const {
  Json stages = Json::array();
  for (std::size_t s = 0; s < kStages; ++s) {
    const Fact& fact = facts_[s];
    const bool probes = static_cast<Stage>(s) == Stage::probes;  // asked once, the others again and again
    if (!probes && !fact.lock && fact.overridden_by.empty()) continue;
    stages.push_back({{"stage", s},
                      {"state", static_cast<int>(fact.state)},
                      {"text", fact.text.substr(0, kLongestText)},
                      {"lock", fact.lock},
                      {"by", fact.overridden_by.substr(0, kLongestText)},
                      {"overridden", fact.overridden.substr(0, kLongestText)}});
  }
  std::string all = Json{{"scope", to_text(scope_)}, {"armed", armed_}, {"stages", std::move(stages)}}.dump(
      -1, ' ', false, Json::error_handler_t::replace);
  return all.size() <= kLongestOutlives ? all : "";
}

void Readiness::take_up(std::string_view outlives) {
  if (scope_ == Scope::live) tell(Stage::probes, State::error, "nobody has looked since the run was cut off");
  const Json before = Json::parse(outlives, nullptr, false);
  if (!before.is_object() || before.value("scope", Json()) != Json(to_text(scope_))) return;
  for (const Json& stage : before.value("stages", Json::array())) {
    const Json number = stage.is_object() ? stage.value("stage", Json()) : Json();
    const Json state = stage.is_object() ? stage.value("state", Json()) : Json();
    if (!number.is_number_unsigned() || number.get<std::uint64_t>() >= kStages) return;
    if (!state.is_number_unsigned() || state.get<std::uint64_t>() > static_cast<std::uint64_t>(State::error)) return;
    const auto text = [&](const char* key) {
      const Json value = stage.value(key, Json());
      return value.is_string() ? value.get<std::string>() : std::string();
    };
    facts_.at(number.get<std::size_t>()) = {static_cast<State>(state.get<int>()), text("text"),
                                            stage.value("lock", Json()) == Json(true), text("by"), text("overridden")};
  }
  armed_ = scope_ == Scope::live && before.value("armed", Json()) == Json(true);
}

std::string stages_text(const Readiness& readiness) {
  std::string text =
      fmt::format("scope {}, {}", to_text(readiness.scope()), readiness.refuses_go() ? "GO is refused" : "GO is there");
  for (const Readiness::Report& stage : readiness.report()) {
    text += fmt::format("\n  {:<8} {:<14}{}{}", to_text(stage.state), stage.name, stage.text,
                        stage.overridden ? " (overridden)" : "");
  }
  return text;
}

std::string stages_json(const Readiness& readiness) {
  nlohmann::ordered_json stages = nlohmann::ordered_json::array();
  for (const Readiness::Report& stage : readiness.report()) {
    stages.push_back({{"name", stage.name}, {"state", to_text(stage.state)}, {"text", stage.text}});
  }
  return nlohmann::ordered_json{
      {"scope", to_text(readiness.scope())}, {"armed", !readiness.refuses_go()}, {"stages", std::move(stages)}}
      .dump();
}

std::string names_text(const std::vector<std::string>& nodes) {
  std::string names;
  for (std::size_t i = 0; i < std::min(nodes.size(), kNamed); ++i) names += (i > 0 ? ", " : "") + nodes[i];
  if (nodes.size() > kNamed) names += fmt::format(" and {} more nodes", nodes.size() - kNamed);
  return names;
}

std::string silence_text(std::size_t silent_markers, std::size_t markers, const std::vector<std::string>& silent) {
  return fmt::format("{} of {} markers silent: {}", grouped(silent_markers), grouped(markers), names_text(silent));
}

std::string unfenced_text(const std::vector<Bus>& buses) {
  const std::vector<std::string> names = drivers::unfenced(buses);
  if (names.empty()) return {};
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return (names.size() == 1 ? "this bus cannot be fenced: " : "these buses cannot be fenced: ") + list +
         " (nothing there refuses another controller)";
}

}  // namespace footlight::app
