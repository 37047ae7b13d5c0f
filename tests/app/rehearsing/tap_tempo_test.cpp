// SPDX-License-Identifier: Apache-2.0
#include "app/rehearsing/tap_tempo.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"

namespace footlight::app {
namespace {

TEST(TapTempo, KnowsNothingBeforeTheThirdTap) {
  TapTempo taps;
  EXPECT_EQ(taps.tap(instant_at(1)), std::nullopt);
  EXPECT_EQ(taps.tap(instant_at(1.5)), std::nullopt);
  EXPECT_NEAR(taps.tap(instant_at(2)).value(), 120, 1e-9);
}

TEST(TapTempo, BeginsAnewAfterAPauseAndForgetsABounce) {
  TapTempo taps;
  for (const double at_s : {0.0, 0.5, 1.0}) (void)taps.tap(instant_at(at_s));
  EXPECT_NEAR(taps.tap(instant_at(1.02)).value(), 120, 1e-9) << "20 ms after the last tap";
  EXPECT_EQ(taps.taps(), 3U);
  EXPECT_EQ(taps.tap(instant_at(4)), std::nullopt);
  EXPECT_EQ(taps.tap(instant_at(5)), std::nullopt);
  EXPECT_NEAR(taps.tap(instant_at(6)).value(), 60, 1e-9);
}

TEST(TapTempoProperty, UnevenTapsGiveTheTempoThatWasMeant) {
  EXPECT_TRUE(rc::check([](std::uint64_t seed) {
    Rng rng(seed);
    const double count_s = 0.25 + 1.5 * rng.uniform();
    TapTempo taps;
    std::optional<double> bpm;
    for (int i = 0; i < 12; ++i) bpm = taps.tap(instant_at(1 + i * count_s + 0.02 * (rng.uniform() - 0.5)));
    // Eight taps, each at most 10 ms off: the slope is off by less than 10 ms x sum |x| / sum x^2 = 10 ms x 16 / 42.
    RC_ASSERT(std::abs(60 / bpm.value() - count_s) < 0.010 * 16 / 42 + 1e-9);
  }));
}

}  // namespace
}  // namespace footlight::app
