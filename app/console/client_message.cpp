// SPDX-License-Identifier: Apache-2.0
#include "app/console/client_message.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace footlight::app {
namespace {

using Json = nlohmann::json;

constexpr std::uint64_t kLargest = std::uint64_t{1} << 53;  // that JavaScript counts exactly

bool has_control(std::string_view text) {
  return std::ranges::any_of(text, [](unsigned char c) { return c < ' ' || c == 0x7f; });
}

/// UTF-8 is known to be right: C1 controls, separators of lines, and marks that turn the direction of text around, so
/// that a name cannot look like another one.
bool has_trick(std::string_view text) {
  for (std::size_t i = 0; i + 1 < text.size(); ++i) {
    const auto at = [&](std::size_t k) { return i + k < text.size() ? static_cast<unsigned char>(text[i + k]) : 0; };
    if (at(0) == 0xc2 && at(1) < 0xa0) return true;
    if (at(0) != 0xe2) continue;
    if (at(1) == 0x80 && ((at(2) >= 0x8b && at(2) <= 0x8f) || (at(2) >= 0xa8 && at(2) <= 0xae))) return true;
    if (at(1) == 0x81 && at(2) >= 0xa0 && at(2) <= 0xaf) return true;
  }
  return false;
}

std::size_t characters(std::string_view text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

/// Nothing when it is no object; nlohmann refuses what is not UTF-8. Nesting is bounded: nothing here needs more.
std::optional<Json> object_from(std::string_view text) {
  if (text.size() > kLongestMessage) return std::nullopt;
  constexpr int kDeepest = 3;
  bool too_deep = false;
  Json json = Json::parse(
      text,
      [&](int depth, Json::parse_event_t, Json&) {
        too_deep = too_deep || depth > kDeepest;
        return !too_deep;
      },
      false);
  if (too_deep || !json.is_object()) return std::nullopt;
  return json;
}

std::optional<std::string> text_in(const Json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_string()) return std::nullopt;
  return found->get<std::string>();
}

std::optional<std::uint64_t> number_from(const Json& value) {
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > kLargest) return std::nullopt;
  return value.get<std::uint64_t>();
}

Result<ClientMessage> hello_from(const Json& value) {
  if (!value.is_object()) return input_error(R"(hello: {"name": "...", "token": "..."})");
  auto name = text_in(value, "name");
  if (!name || name->empty() || characters(*name) > kLongestName || has_control(*name) || has_trick(*name)) {
    return input_error(fmt::format("hello: a name of 1 to {} characters that are shown", kLongestName));
  }
  auto token = text_in(value, "token");
  if (!token && value.contains("token")) return input_error("hello: the token is text");
  Hello hello{*std::move(name), token.value_or("")};
  if (value.contains("role")) {
    const auto role = paired_role_from(text_in(value, "role").value_or(""));
    if (!role) return input_error("hello: the role is \"view\" or \"operate\"");
    hello.most = *role;
  }
  return ClientMessage{std::move(hello)};
}

Result<ClientMessage> order_from(const Json& object, const Json& value) {
  if (!value.is_string()) return input_error("order: text, as \"go\"");
  OrderSaid order{value.get<std::string>(), std::nullopt};
  if (order.line.size() > kLongestOrder || has_control(order.line)) {
    return input_error(fmt::format("order: at most {} bytes, and no control characters", kLongestOrder));
  }
  if (const auto id = object.find("id"); id != object.end()) {
    order.id = number_from(*id);
    if (!order.id) return input_error("order: id is a whole number from 0 to 2^53");
  }
  return ClientMessage{std::move(order)};
}

Result<ClientMessage> seat_from(const Json& value) {
  if (value == "take") return ClientMessage{SeatWish{true}};
  if (value == "leave") return ClientMessage{SeatWish{false}};
  return input_error("seat: \"take\" or \"leave\"");
}

Result<ClientMessage> pair_from(const Json& value) {
  const auto role = value.is_string() ? paired_role_from(value.get<std::string>()) : std::nullopt;
  if (!role) return input_error("pair: \"view\" or \"operate\"");
  return ClientMessage{PairWish{*role}};
}

Result<ClientMessage> message_in(const Json& object, std::string_view key, const Json& value) {
  if (key == "hello") return hello_from(value);
  if (key == "order") return order_from(object, value);
  if (key == "seat") return seat_from(value);
  if (key == "pair") return pair_from(value);
  const auto number = number_from(value);
  if (!number) return input_error(fmt::format("{}: a whole number from 0 to 2^53", key));
  if (key == "ping") return ClientMessage{Ping{*number}};
  return ClientMessage{Acknowledge{*number}};
}

}  // namespace

Result<ClientMessage> client_message_from(std::string_view text) {
  constexpr std::array<std::string_view, 6> kKeys{"hello", "order", "seat", "acknowledge", "pair", "ping"};
  const auto object = object_from(text);
  if (!object) return input_error("a JSON object in UTF-8, of at most 4096 bytes");
  std::string_view known;
  for (const std::string_view key : kKeys) {
    if (!object->contains(key)) continue;
    if (!known.empty()) return input_error("one message at a time");
    known = key;
  }
  if (known.empty()) return input_error("one of hello, order, seat, acknowledge, pair, ping");
  return message_in(*object, known, (*object)[std::string(known)]);
}

Result<std::string> code_from(std::string_view body) {
  const auto object = object_from(body);
  auto code = object ? text_in(*object, "code") : std::nullopt;
  if (!code) return input_error(R"({"code": "12345678"})");
  std::erase_if(*code, [](char c) { return c == ' ' || c == '-'; });
  return *std::move(code);
}

std::string verb_of(std::string_view order) {
  const auto space = [](char c) { return c == ' '; };
  const auto* begin = std::ranges::find_if_not(order, space);
  const auto* end = std::find_if(begin, order.end(), space);
  std::string verb(begin, end);
  std::ranges::transform(verb, verb.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return verb;
}

bool is_hold(std::string_view order) { return verb_of(order) == "hold"; }

}  // namespace footlight::app
