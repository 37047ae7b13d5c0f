// SPDX-License-Identifier: Apache-2.0
#include "app/remote/osc_calls.hpp"

#include <map>
#include <string_view>

namespace footlight::app {
namespace {

using Kind = RemoteCall::Kind;

std::optional<double> number_of(const OscValue& value) {
  if (const auto* whole = std::get_if<std::int32_t>(&value)) return *whole;
  if (const auto* real = std::get_if<double>(&value)) return *real;
  return std::nullopt;
}

std::optional<std::string> text_of(const OscMessage& message) {
  if (message.values.size() != 1 || !std::holds_alternative<std::string>(message.values[0])) return std::nullopt;
  return std::get<std::string>(message.values[0]);
}

OscAsked call(Kind kind, std::string text = {}) { return {OscAsked::Kind::call, {kind, std::move(text)}}; }
OscAsked unknown(std::string why) { return {OscAsked::Kind::unknown, {}, {}, std::move(why)}; }

const std::map<std::string_view, RemoteCall>& plain_calls() {
  static const std::map<std::string_view, RemoteCall> kCalls{
      {"/go", {Kind::go}},         {"/stop", {Kind::hold}},  {"/pause", {Kind::hold}},
      {"/resume", {Kind::resume}}, {"/panic", {Kind::hold}}, {"/standby", {Kind::order, "standby"}},
  };
  return kCalls;
}

/// "/cue/12.5/start"
OscAsked asked_of_cue(std::string_view rest) {
  const auto slash = rest.find('/');
  const std::string number(rest.substr(0, slash));
  const std::string_view verb = slash == std::string_view::npos ? "" : rest.substr(slash + 1);
  if (!CueNumber::parse(number)) return unknown("\"" + number + "\" is not a cue number");
  if (verb == "start") return call(Kind::start_cue, number);
  if (verb == "load") return call(Kind::load_cue, number);
  return unknown("/cue/" + number + "/start or /cue/" + number + "/load");
}

OscAsked asked_of_input(const OscMessage& message, bool gate) {
  const auto& values = message.values;
  const auto on = values.size() == 2 ? number_of(values[1]) : std::nullopt;
  if (!on || !std::holds_alternative<std::string>(values[0])) return unknown("a name, and 1 or 0");
  return {OscAsked::Kind::input, {}, {gate, std::get<std::string>(values[0]), *on != 0}};
}

}  // namespace

OscAsked asked_by(const OscMessage& message) {
  const std::string_view address = message.address;
  // Control surfaces send 1 when a button goes down and 0 when it comes up.
  if (message.values.size() == 1 && number_of(message.values[0]) == 0.0) return {OscAsked::Kind::nothing};
  if (const auto plain = plain_calls().find(address); plain != plain_calls().end()) {
    return {OscAsked::Kind::call, plain->second};
  }
  if (address.starts_with("/cue/")) return asked_of_cue(address.substr(5));
  if (address == "/footlight/button") return asked_of_input(message, false);
  if (address == "/footlight/gate") return asked_of_input(message, true);
  if (address == "/footlight/state") return {OscAsked::Kind::state};
  if (address == "/thump") return {OscAsked::Kind::nothing};
  if (address == "/connect" || address == "/footlight/order") {
    const auto text = text_of(message);
    if (!text) return unknown("one string");
    return {address == "/connect" ? OscAsked::Kind::connect : OscAsked::Kind::call, {Kind::order, *text}};
  }
  return unknown(
      "no such address (/go, /stop, /pause, /resume, /panic, /standby, /cue/{number}/start, "
      "/cue/{number}/load, /footlight/order)");
}

}  // namespace footlight::app
