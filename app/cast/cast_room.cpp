// SPDX-License-Identifier: Apache-2.0
#include "app/cast/cast_room.hpp"

#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/secret.hpp"

namespace footlight::app {
namespace {

using Json = nlohmann::json;
using About = PhoneQuestion::About;

constexpr std::size_t kLongest = 512;
constexpr int kDeepest = 3;

std::optional<Json> object_from(std::string_view text) {
  if (text.size() > kLongest) return std::nullopt;
  bool too_deep = false;
  Json json = Json::parse(
      text,
      [&](int depth, Json::parse_event_t, Json&) {
        too_deep = too_deep || depth > kDeepest;
        return !too_deep;
      },
      false);
  if (too_deep || !json.is_object() || json.size() != 1) return std::nullopt;
  return json;
}

std::optional<std::uint32_t> index_in(const Json& value, const char* key) {
  const auto found = value.find(key);
  if (found == value.end() || !found->is_number_unsigned() || found->get<std::uint64_t>() > 0xffffffffU) return {};
  return found->get<std::uint32_t>();
}

Result<PhoneMessage> question_from(About about, const std::string& key, const Json& value) {
  const auto wrong = [&] {
    return input_error(key + (about == About::where ? R"(: {"who": 7, "cell": 12, "language": "en"})"
                                                    : R"(: {"who": 7, "language": "en"})"));
  };
  if (!value.is_object()) return wrong();
  const auto who = index_in(value, "who");
  const auto cell = index_in(value, "cell");
  const auto language = value.find("language");
  if (!who || (about == About::where && !cell) || language == value.end() || !language->is_string()) return wrong();
  const auto known = language_from(language->get<std::string>());
  if (!known) return wrong();
  return PhoneMessage{PhoneQuestion{about, PerformerIndex(*who), *known, CellIndex(cell.value_or(0))}};
}

}  // namespace

Result<PhoneMessage> phone_message_from(std::string_view text) {
  const auto object = object_from(text);
  if (!object) return input_error("one JSON object in UTF-8, of at most 512 bytes and with one key");
  const std::string key = object->begin().key();
  const Json& value = object->begin().value();
  if (key == "hello") {
    const auto token = value.is_object() ? value.find("token") : value.end();
    if (!value.is_object() || token == value.end() || !token->is_string())
      return input_error(R"(hello: {"token": "..."})");
    return PhoneMessage{PhoneHello{token->get<std::string>()}};
  }
  if (key == "ping") {
    if (!value.is_number() || !std::isfinite(value.get<double>())) return input_error("ping: a number");
    return PhoneMessage{PhonePing{value.get<double>()}};
  }
  if (key == "part") return question_from(About::part, key, value);
  if (key == "way") return question_from(About::way, key, value);
  if (key == "where") return question_from(About::where, key, value);
  return input_error("one of hello, ping, part, way, where");
}

CastRoom::CastRoom(Mailer& mailer, std::string token, const Clock& clock,
                   std::function<bool(PersonId, const PhoneQuestion&)> ask)
    : mailer_(mailer), token_(std::move(token)), clock_(clock), ask_(std::move(ask)) {}

PersonId CastRoom::enter() {
  const PersonId id = ++last_;
  phones_[id].since = clock_.now();
  return id;
}

void CastRoom::heard(PersonId who, std::string_view message) {
  const auto found = phones_.find(who);
  if (found == phones_.end()) return;
  Phone& phone = found->second;
  if (!phone.messages.take(clock_.now())) return mailer_.close(who, Room::kFlood, "too many messages");
  const auto understood = phone_message_from(message);
  if (!understood) return mailer_.close(who, Room::kNotUnderstood, understood.error().message);
  if (const auto* hello = std::get_if<PhoneHello>(&*understood); hello != nullptr) {
    if (phone.welcome) return mailer_.close(who, Room::kNotUnderstood, "hello has been said");
    if (!same_secret(token_, hello->token)) return mailer_.close(who, Room::kToken, "the token is not good");
    phone.welcome = true;
    if (state_) mailer_.send_state(who, state_);
    return;
  }
  if (!phone.welcome) return mailer_.close(who, Room::kNotUnderstood, "hello comes first");
  if (const auto* ping = std::get_if<PhonePing>(&*understood); ping != nullptr) {
    const double now_ms = std::round(to_seconds(clock_.now()) * 1e4) / 10;
    return mailer_.send(who,
                        std::make_shared<const std::string>(Json{{"pong", ping->number}, {"now_ms", now_ms}}.dump()));
  }
  take(who, phone, std::get<PhoneQuestion>(*understood));
}

void CastRoom::take(PersonId who, Phone& phone, const PhoneQuestion& question) {
  if (phone.questions.take(clock_.now()) && ask_(who, question)) return;
  mailer_.send(who, std::make_shared<const std::string>(R"({"busy":2})"));
}

void CastRoom::tick() {
  std::vector<PersonId> silent;
  for (const auto& [id, phone] : phones_) {
    if (!phone.welcome && clock_.now() - phone.since > kHelloWithin) silent.push_back(id);
  }
  for (const PersonId id : silent) mailer_.close(id, Room::kNotUnderstood, "no hello in time");
}

void CastRoom::state(Letter letter) {
  state_ = std::move(letter);
  for (const auto& [id, phone] : phones_) {
    if (phone.welcome) mailer_.send_state(id, state_);
  }
}

}  // namespace footlight::app
