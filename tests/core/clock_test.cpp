// SPDX-License-Identifier: Apache-2.0
#include "core/clock.hpp"

#include <gtest/gtest.h>

namespace footlight {
namespace {

TEST(ManualClock, StandsStillUntilItIsMoved) {
  ManualClock clock;
  EXPECT_EQ(clock.now(), kStart);
  EXPECT_EQ(clock.now(), kStart);
  clock.advance(milliseconds(5));
  EXPECT_EQ(clock.now(), instant_at(0.005));
  clock.advance_to(instant_at(3));
  clock.advance_to(instant_at(3));
  EXPECT_EQ(clock.now(), instant_at(3));
}

TEST(ManualClockDeathTest, GoingBackIsAProgrammerError) {
  ManualClock clock;
  clock.advance_to(instant_at(3));
  EXPECT_DEATH(clock.advance_to(instant_at(2)), "instant >= now");
}

TEST(SteadyClock, BeginsAtZeroAndNeverGoesBack) {
  const SteadyClock clock;
  Instant before = clock.now();
  EXPECT_GE(before, kStart);
  for (int k = 0; k < 1000; ++k) {
    const Instant now = clock.now();
    ASSERT_GE(now, before);
    before = now;
  }
}

}  // namespace
}  // namespace footlight
