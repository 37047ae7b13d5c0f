// SPDX-License-Identifier: Apache-2.0
#include "app/remote/msc.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/show.hpp"

namespace footlight::app {
namespace {

using Kind = RemoteCall::Kind;

constexpr std::uint8_t kAllCall = 0x7F;
constexpr std::uint8_t kAllTypes = 0x7F;
constexpr std::size_t kShortest = 7;  // without data

constexpr std::uint8_t kGo = 0x01;
constexpr std::uint8_t kStop = 0x02;
constexpr std::uint8_t kResume = 0x03;
constexpr std::uint8_t kLoad = 0x05;
constexpr std::uint8_t kFire = 0x07;
constexpr std::uint8_t kAllOff = 0x08;
constexpr std::uint8_t kReset = 0x0A;

bool for_us(std::span<const std::uint8_t> message, const config::MidiRemote& settings) {
  if (message.size() < kShortest || message[0] != 0xF0 || message[1] != 0x7F || message[3] != 0x02) return false;
  if (message.back() != 0xF7) return false;
  const bool device = message[2] == kAllCall || message[2] == settings.device;
  const bool format = message[4] == kAllTypes || message[4] == settings.format;
  return device && format;
}

/// The cue number at the beginning of the data: digits and points, up to the first zero byte.
std::string cue_in(std::span<const std::uint8_t> data) {
  const auto end = std::ranges::find(data, std::uint8_t{0});
  return {data.begin(), end};
}

MscHeard with_cue(std::span<const std::uint8_t> data, Kind without, Kind with) {
  const std::string cue = cue_in(data);
  if (cue.empty()) return {RemoteCall{without}};
  const auto number = CueNumber::parse(cue);
  if (!number) return {{}, "what should be a cue number is none"};
  return {RemoteCall{with, number->to_text()}};
}

MscHeard fire(std::span<const std::uint8_t> data, const config::MidiRemote& settings) {
  if (data.size() != 1) return {{}, "FIRE without the number of a macro"};
  const auto macro = std::ranges::find(settings.macros, static_cast<int>(data[0]), &config::MidiRemote::Macro::number);
  if (macro == settings.macros.end()) return {{}, fmt::format("FIRE: no macro {} (midi.macros)", data[0])};
  return {RemoteCall{Kind::order, macro->order}};
}

}  // namespace

MscHeard hear_msc(std::span<const std::uint8_t> message, const config::MidiRemote& settings) {
  if (!for_us(message, settings)) return {};
  const std::uint8_t command = message[5];
  const auto data = message.subspan(6, message.size() - kShortest);
  switch (command) {
    case kGo:
      return with_cue(data, Kind::go, Kind::start_cue);
    case kStop:
      return {RemoteCall{Kind::hold}};  // whichever cue is meant: people stand
    case kResume:
      return {RemoteCall{Kind::resume}};
    case kLoad:
      if (cue_in(data).empty()) return {{}, "LOAD without a cue number"};
      return with_cue(data, Kind::load_cue, Kind::load_cue);
    case kFire:
      return fire(data, settings);
    case kAllOff:
      return {RemoteCall{Kind::hold}};
    case kReset:
      return {RemoteCall{Kind::top}};
    default:
      return {
          {},
          fmt::format("command {:02X} is not carried out (GO, STOP, RESUME, LOAD, FIRE, ALL_OFF, RESET are)", command)};
  }
}

}  // namespace footlight::app
