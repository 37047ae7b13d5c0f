// SPDX-License-Identifier: Apache-2.0
#include "controller/time/mtc.hpp"

#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"

namespace footlight::controller {
namespace {

TEST(Mtc, EightQuarterFramesSayWhereTheSourceIsNowNotWhereItWas) {
  for (const FrameRate rate : {FrameRate::fps24, FrameRate::fps25, FrameRate::fps2997_drop, FrameRate::fps30}) {
    MtcDecoder decoder;
    const Duration step = frame_time(rate) / 4;
    int fixes = 0;
    for (int q = 0; q < 80; ++q) {
      const Instant at = instant_at(10) + q * step;
      const auto fix = decoder.take(mtc_quarter(code_of(90'000 + q / 8 * 2, rate), q % 8), at);
      if (!fix) continue;
      ++fixes;
      EXPECT_EQ(fix->at, at);
      EXPECT_LE(std::abs((fix->position - (time_of(code_of(90'000, rate)) + q * step)).count()), 200) << q;
    }
    EXPECT_EQ(fixes, 10);
  }
}

TEST(Mtc, BackwardsItRunsBackwards) {
  MtcDecoder decoder;
  std::vector<TimeFix> fixes;
  for (int q = 800; q > 700; --q) {
    const Instant at = kStart + (800 - q) * milliseconds(10);
    if (const auto fix = decoder.take(mtc_quarter(code_of(q / 8 * 2, FrameRate::fps25), q % 8), at)) {
      fixes.push_back(*fix);
    }
  }
  ASSERT_GE(fixes.size(), 10U);
  for (std::size_t i = 1; i < fixes.size(); ++i) {
    EXPECT_EQ(fixes[i].position - fixes[i - 1].position, -milliseconds(80));
    EXPECT_EQ(fixes[i].position, milliseconds(8000) - (fixes[i].at - kStart)) << i;
  }
}

TEST(Mtc, AFullFrameIsAPlaceAtOnce) {
  MtcDecoder decoder;
  const Timecode code{1, 2, 3, 4, FrameRate::fps25};
  const auto message = mtc_full_frame(code);
  EXPECT_EQ(message, (std::array<std::uint8_t, 10>{0xF0, 0x7F, 0x7F, 0x01, 0x01, 0x21, 0x02, 0x03, 0x04, 0xF7}));
  const auto fix = decoder.take(message, instant_at(5));
  ASSERT_TRUE(fix);
  EXPECT_EQ(decoder.last(), code);
  EXPECT_EQ(fix->position, seconds(3723.16));
}

TEST(Mtc, AfterALostPieceNothingIsSaidUntilAWholeCodeHasCome) {
  MtcDecoder decoder;
  std::vector<int> said;
  for (int q = 0; q < 32; ++q) {
    if (q == 11) continue;
    if (decoder.take(mtc_quarter(code_of(q / 8 * 2, FrameRate::fps25), q % 8), kStart)) said.push_back(q);
  }
  EXPECT_EQ(said, (std::vector<int>{7, 23, 31}));
}

TEST(Mtc, NoMessagesBreakItAndWhatItSaysIsATime) {
  EXPECT_TRUE(rc::check("MTC from garbage", [] {
    Rng rng(*rc::gen::arbitrary<std::uint64_t>());
    MtcDecoder decoder;
    for (int i = 0; i < 20'000; ++i) {
      std::array<std::uint8_t, 12> message{};
      for (auto& byte : message) byte = static_cast<std::uint8_t>(rng.below(256));
      std::size_t size = rng.below(message.size() + 1);
      if (rng.below(3) == 0) {
        message[0] = 0xF1;
        size = 2;
      }
      if (rng.below(9) == 0) {
        const std::array<std::uint8_t, 5> full{0xF0, 0x7F, 0x7F, 0x01, 0x01};
        std::ranges::copy(full, message.begin());
        size = 10;
      }
      const auto fix = decoder.take(std::span(message).first(size), kStart);
      if (!fix) continue;
      RC_ASSERT(valid(*decoder.last()));
      RC_ASSERT(fix->position >= Duration{});
      RC_ASSERT(fix->position < seconds(25 * 3600.0));
    }
  }));
}

}  // namespace
}  // namespace footlight::controller
