// SPDX-License-Identifier: Apache-2.0
#include "controller/time/midi_clock.hpp"

#include <array>

#include <gtest/gtest.h>

#include "core/rng.hpp"

namespace footlight::controller {
namespace {

std::optional<MidiClockDecoder::Beat> take(MidiClockDecoder& decoder, std::uint8_t status, Instant at) {
  return decoder.take(std::array{status}, at);
}

TEST(MidiClock, TheFirstClockAfterStartIsTheBeginningOfTheSong) {
  MidiClockDecoder decoder;
  EXPECT_FALSE(take(decoder, 0xF8, kStart)) << "a clock that runs for ever is no song";
  EXPECT_FALSE(take(decoder, 0xFA, kStart));
  const Duration clock = milliseconds(500) / 24;  // 120 a minute
  int told = 0;
  for (int c = 0; c < 240; ++c) {
    const auto beat = take(decoder, 0xF8, instant_at(1) + c * clock);
    if (!beat) continue;
    ++told;
    EXPECT_DOUBLE_EQ(beat->quarters, c / 24.0);
  }
  EXPECT_EQ(told, 120) << "every second clock: none within 30 ms";
}

TEST(MidiClock, StopsAndGoesOnAndASongPositionIsSixteenths) {
  MidiClockDecoder decoder;
  take(decoder, 0xFA, kStart);
  for (int c = 0; c < 48; ++c) take(decoder, 0xF8, instant_at(0.02 * c));
  take(decoder, 0xFC, instant_at(1));
  EXPECT_FALSE(decoder.runs());
  EXPECT_FALSE(take(decoder, 0xF8, instant_at(2))) << "clocks go on while the song is stopped";
  take(decoder, 0xFB, instant_at(3));
  EXPECT_DOUBLE_EQ(take(decoder, 0xF8, instant_at(3))->quarters, 2);
  take(decoder, 0xFC, instant_at(4));
  decoder.take(std::array<std::uint8_t, 3>{0xF2, 0x02, 0x01}, instant_at(4));  // 130 sixteenths
  take(decoder, 0xFB, instant_at(5));
  EXPECT_DOUBLE_EQ(take(decoder, 0xF8, instant_at(5))->quarters, 32.5);
}

TEST(MidiClock, GarbageDoesNoHarm) {
  Rng rng(3);
  MidiClockDecoder decoder;
  for (int i = 0; i < 100'000; ++i) {
    std::array<std::uint8_t, 3> message{};
    for (auto& byte : message)
      byte = static_cast<std::uint8_t>(rng.below(2) == 0 ? 0xF0 + rng.below(16) : rng.below(256));
    const auto beat = decoder.take(std::span(message).first(rng.below(4)), kStart + i * milliseconds(1));
    if (beat) {
      EXPECT_GE(beat->quarters, 0);
    }
  }
}

}  // namespace
}  // namespace footlight::controller
