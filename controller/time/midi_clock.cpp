// SPDX-License-Identifier: Apache-2.0
#include "controller/time/midi_clock.hpp"

namespace footlight::controller {
namespace {

constexpr double kClocksAQuarter = 24;
constexpr std::int64_t kClocksASixteenth = 6;
constexpr Duration kTell = milliseconds(30);

}  // namespace

std::optional<MidiClockDecoder::Beat> MidiClockDecoder::take(std::span<const std::uint8_t> message,
                                                             Instant at) noexcept {
  if (message.empty()) return std::nullopt;
  switch (message[0]) {
    case 0xF2:
      if (message.size() == 3) clocks_ = kClocksASixteenth * (message[1] + 128 * message[2]);
      return std::nullopt;
    case 0xFA:
      clocks_ = 0;
      [[fallthrough]];
    case 0xFB:
      runs_ = true;  // from the next clock on, which is that of this very place
      told_at_.reset();
      return std::nullopt;
    case 0xFC:
      runs_ = false;
      return std::nullopt;
    case 0xF8:
      break;
    default:
      return std::nullopt;
  }
  if (!runs_) return std::nullopt;
  const auto clock = static_cast<double>(clocks_++);
  if (told_at_ && at - *told_at_ < kTell) return std::nullopt;
  told_at_ = at;
  return Beat{at, clock / kClocksAQuarter};
}

}  // namespace footlight::controller
