// SPDX-License-Identifier: Apache-2.0
#include "controller/time/mtc.hpp"

#include "core/check.hpp"

namespace footlight::controller {
namespace {

constexpr std::uint8_t kExclusive = 0xF0;
constexpr std::uint8_t kQuarterFrame = 0xF1;
constexpr std::size_t kFullFrameSize = 10;
constexpr int kPieces = 8;

std::uint8_t hours_and_rate(const Timecode& code) {
  return static_cast<std::uint8_t>(static_cast<unsigned>(code.rate) << 5U | static_cast<unsigned>(code.hours));
}

}  // namespace

std::optional<TimeFix> MtcDecoder::take(std::span<const std::uint8_t> message, Instant at) noexcept {
  if (message.size() == 2 && message[0] == kQuarterFrame) return quarter(message[1], at);
  if (message.size() == kFullFrameSize && message[0] == kExclusive) return full_frame(message, at);
  return std::nullopt;
}

std::optional<TimeFix> MtcDecoder::full_frame(std::span<const std::uint8_t> message, Instant at) noexcept {
  if (message[1] != 0x7F || message[3] != 0x01 || message[4] != 0x01) return std::nullopt;
  const Timecode code{message[5] & 0x1F, message[6], message[7], message[8],
                      static_cast<FrameRate>((message[5] >> 5U) & 3U)};
  expected_ = -1;
  in_a_row_ = 0;
  if (!valid(code)) return std::nullopt;
  last_ = code;
  return TimeFix{at, time_of(code)};
}

std::optional<TimeFix> MtcDecoder::quarter(std::uint8_t data, Instant at) noexcept {
  const int number = (data >> 4U) & 7;
  const int before = (expected_ + kPieces - 2) % kPieces;  // of the one that came last
  const int direction = expected_ >= 0 && number == before ? -1 : 1;
  const bool fits = expected_ >= 0 && (number == expected_ || number == before);
  in_a_row_ = !fits ? 1 : direction == direction_ ? in_a_row_ + 1 : 2;
  direction_ = direction;
  pieces_[static_cast<std::size_t>(number)] = data & 0x0FU;
  expected_ = (number + 1) % kPieces;
  if (number != (direction_ > 0 ? kPieces - 1 : 0) || in_a_row_ < kPieces) return std::nullopt;
  in_a_row_ = 0;  // the next code is whole after eight pieces of its own
  const auto two = [&](std::size_t low) { return pieces_[low] | (pieces_[low + 1] << 4U); };
  const Timecode code{two(6) & 0x1F, two(4) & 0x3F, two(2) & 0x3F, two(0) & 0x1F,
                      static_cast<FrameRate>((pieces_[7] >> 1U) & 3U)};
  if (!valid(code)) return std::nullopt;
  last_ = code;
  return TimeFix{at, time_of(code) + (direction_ > 0 ? 7 * frame_time(code.rate) / 4 : Duration{})};
}

std::array<std::uint8_t, 2> mtc_quarter(const Timecode& code, int piece) {
  FL_CHECK(piece >= 0 && piece < kPieces && valid(code));
  const std::array<int, 4> numbers{code.frames, code.seconds, code.minutes, hours_and_rate(code)};
  const int number = numbers.at(static_cast<std::size_t>(piece) / 2);
  return {kQuarterFrame, static_cast<std::uint8_t>(piece << 4 | (piece % 2 == 0 ? number & 15 : number >> 4))};
}

std::array<std::uint8_t, 10> mtc_full_frame(const Timecode& code) {
  FL_CHECK(valid(code));
  const auto byte = [](int value) { return static_cast<std::uint8_t>(value); };
  return {kExclusive,        0x7F, 0x7F, 0x01, 0x01, hours_and_rate(code), byte(code.minutes), byte(code.seconds),
          byte(code.frames), 0xF7};
}

}  // namespace footlight::controller
