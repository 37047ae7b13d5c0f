// SPDX-License-Identifier: Apache-2.0
#include "controller/time/ltc.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "tests/controller/time/tape.hpp"

namespace footlight::controller {
namespace {

using tests::sound_of;
using tests::Tape;
using tests::TapePiece;

constexpr int kSampleRate = 48'000;

Tape tape(FrameRate rate, double lasts_s, double speed = 1) {
  return {rate, to_seconds(time_of({1, 0, 0, 0, rate})), {{.lasts_s = lasts_s, .speed = speed, .speed_at_end = speed}}};
}

std::vector<TimeFix> decode(LtcDecoder& decoder, const std::vector<float>& sound, Instant began = instant_at(100)) {
  std::vector<TimeFix> fixes;
  for (std::size_t i = 0; i < sound.size(); i += 480) {
    decoder.take(std::span(sound).subspan(i, std::min<std::size_t>(480, sound.size() - i)), began,
                 [&](const TimeFix& fix) { fixes.push_back(fix); });
  }
  return fixes;
}

/// Where the tape is at a fix, off where the fix says that it is, ms; the worst of all.
double worst_ms(const std::vector<TimeFix>& fixes, const Tape& tape) {
  double worst_ms = 0;
  for (const TimeFix& fix : fixes) {
    const double truth_s = tape.begins_s + to_seconds(fix.at - instant_at(100)) * tape.pieces[0].speed;
    worst_ms = std::max(worst_ms, std::abs(to_seconds(fix.position) - truth_s) * 1e3);
  }
  return worst_ms;
}

TEST(Ltc, SaysWhereTheTapeIsAtAllFourRates) {
  for (const FrameRate rate : {FrameRate::fps24, FrameRate::fps25, FrameRate::fps2997_drop, FrameRate::fps30}) {
    LtcDecoder decoder(kSampleRate, FrameRate::fps25);
    const Tape played = tape(rate, 4);
    const auto fixes = decode(decoder, sound_of(played, kSampleRate, 0, 1));
    EXPECT_GE(fixes.size(), 90U) << to_text(rate);
    // Until two seconds have ended the rate is a guess.
    const std::vector<TimeFix> known(fixes.begin() + 62, fixes.end());
    EXPECT_LT(worst_ms(known, played), 2) << to_text(rate);
    EXPECT_TRUE(decoder.knows_rate());
    EXPECT_EQ(decoder.rate(), rate);
  }
}

TEST(Ltc, FollowsATapeThatRunsFasterAndSlower) {
  for (const double speed : {0.5, 0.9, 1.1, 2.0}) {
    LtcDecoder decoder(kSampleRate, FrameRate::fps25);
    const Tape played = tape(FrameRate::fps25, 4 / speed, speed);
    const auto fixes = decode(decoder, sound_of(played, kSampleRate, 0, 1));
    EXPECT_GE(fixes.size(), 90U) << speed;
    EXPECT_LT(worst_ms(fixes, played), 4) << speed;
  }
}

TEST(Ltc, IsHeardThroughNoise) {
  LtcDecoder decoder(kSampleRate, FrameRate::fps25);
  const Tape played = tape(FrameRate::fps25, 10);
  const auto fixes = decode(decoder, sound_of(played, kSampleRate, 0.05, 7));
  EXPECT_GE(fixes.size(), 240U);
  EXPECT_LT(worst_ms(fixes, played), 2);
}

TEST(Ltc, IsHeardAgainAfterASecondOfHissOrOfSilence) {
  for (const int sample_rate : {8'000, 44'100, 48'000, 96'000}) {
    for (const double noise : {0.0, 0.02, 0.08, 0.3}) {
      Tape played = tape(FrameRate::fps25, 3);
      played.pieces.push_back({.kind = TapePiece::Kind::silent, .lasts_s = 1});
      played.pieces.push_back({.lasts_s = 3});
      LtcDecoder decoder(sample_rate, FrameRate::fps25);
      std::vector<float> sound = sound_of(played, sample_rate, 0, 7);
      Rng rng(8);
      const auto second = static_cast<std::size_t>(sample_rate);
      for (std::size_t i = 3 * second; i < 4 * second; ++i)
        sound[i] += static_cast<float>(noise * (2 * rng.uniform() - 1));
      const auto fixes = decode(decoder, sound);
      const auto again = std::ranges::find_if(fixes, [](const TimeFix& fix) { return fix.at > instant_at(104); });
      ASSERT_NE(again, fixes.end()) << sample_rate << " Hz, hiss " << noise;
      EXPECT_LT(again->at, instant_at(104.6)) << sample_rate << " Hz, hiss " << noise;
    }
  }
}

TEST(Ltc, AGapAtTheEndOfASecondTeachesNoWrongRate) {
  // The last frame of a second is missing: 25 frames a second would look like 24.
  for (double gap_s = 0.9; gap_s < 1.1; gap_s += 0.02) {
    LtcDecoder decoder(kSampleRate, FrameRate::fps30);
    Tape played = tape(FrameRate::fps25, gap_s);
    played.pieces.push_back({.kind = TapePiece::Kind::silent, .lasts_s = 0.04});
    played.pieces.push_back({.lasts_s = 0.5});
    (void)decode(decoder, sound_of(played, kSampleRate, 0, 1));
    EXPECT_TRUE(!decoder.knows_rate() || decoder.rate() == FrameRate::fps25) << gap_s;
  }
}

TEST(Ltc, SilenceAndNoiseAloneAndWhatIsNoNumberSayNothing) {
  Rng rng(7);
  std::vector<float> noise(5 * kSampleRate);
  LtcDecoder decoder(kSampleRate, FrameRate::fps25);
  EXPECT_TRUE(decode(decoder, noise).empty());
  for (float& sample : noise) sample = static_cast<float>(2 * rng.uniform() - 1);
  EXPECT_TRUE(decode(decoder, noise).empty());
  for (float& sample : noise) {
    const std::uint64_t dice = rng.below(4);
    sample = dice == 0 ? std::numeric_limits<float>::quiet_NaN() : dice == 1 ? 1e30F : -1e30F;
  }
  EXPECT_TRUE(decode(decoder, noise).empty());
}

}  // namespace
}  // namespace footlight::controller
