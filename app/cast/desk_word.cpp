// SPDX-License-Identifier: Apache-2.0
#include "app/cast/desk_word.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

namespace footlight::app {
namespace {

using Json = nlohmann::json;
using Phase = DeskWord::Phase;

constexpr std::array<std::string_view, 6> kPhases{"stands", "counts-in", "runs", "resets", "reset-held", "finished"};

const Json* in(const Json& object, const char* key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

std::optional<double> number_in(const Json& object, const char* key) {
  const Json* value = in(object, key);
  if (value == nullptr || !value->is_number()) return std::nullopt;
  const double number = value->get<double>();
  constexpr double kLongest = 1e7;  // s: nothing on a stage lasts longer
  return std::isfinite(number) && std::abs(number) <= kLongest ? std::optional(number) : std::nullopt;
}

std::string text_in(const Json& object, const char* key) {
  const Json* value = in(object, key);
  constexpr std::size_t kLongest = 200;
  return value != nullptr && value->is_string() ? value->get<std::string>().substr(0, kLongest) : std::string();
}

std::optional<DeskWord> word_from(const Json& state) {
  const std::string phase = text_in(state, "phase");
  const auto* const known = std::find(kPhases.begin(), kPhases.end(), phase);
  const auto position = number_in(state, "position_s");
  if (known == kPhases.end() || !position) return std::nullopt;
  DeskWord word;
  word.phase = static_cast<Phase>(known - kPhases.begin());
  word.position_s = *position;
  const bool runs = word.phase == Phase::runs;
  word.tempo_percent = static_cast<int>(number_in(state, "tempo_percent").value_or(100));
  word.rate = number_in(state, "rate").value_or(runs ? word.tempo_percent / 100.0 : 0);
  word.goes_in_s = number_in(state, "goes_in_s");
  word.cue = text_in(state, "cue");
  word.standby = text_in(state, "standby");
  const Json* hold = in(state, "holds_at_end");
  word.holds_at_end = hold != nullptr && hold->is_boolean() && hold->get<bool>();
  if (const Json* loop = in(state, "loop"); loop != nullptr) {
    const auto from = number_in(*loop, "from_s");
    const auto to = number_in(*loop, "to_s");
    if (from && to) word.loop = DeskWord::Loop{*from, *to};
  }
  if (const Json* reset = in(state, "reset"); reset != nullptr) {
    word.way_s = number_in(*reset, "at_s");
    const auto from = number_in(*reset, "from_s");
    const auto to = number_in(*reset, "to_s");
    if (from && to) word.way_between = DeskWord::Loop{*from, *to};
    word.way = text_in(*reset, "state") == "ready" || word.way_s.has_value();
  }
  return word;
}

}  // namespace

std::string_view to_text(Phase phase) { return kPhases.at(static_cast<std::size_t>(phase)); }

DeskMessage desk_message_from(std::string_view text) {
  DeskMessage out;
  const Json json = Json::parse(text, nullptr, false);
  if (const Json* welcome = in(json, "welcome"); welcome != nullptr) {
    out.welcome = DeskMessage::Welcome{text_in(*welcome, "plan"), text_in(*welcome, "run")};
  }
  if (const Json* state = in(json, "state"); state != nullptr) out.state = word_from(*state);
  out.epoch = in(json, "epoch") != nullptr;
  if (out.epoch && in(json, "plan") != nullptr) out.plan = text_in(json, "plan");
  return out;
}

}  // namespace footlight::app
