// SPDX-License-Identifier: Apache-2.0
#include "core/time.hpp"

#include <gtest/gtest.h>

namespace footlight {
namespace {

TEST(Time, SecondsAreRoundedToTheNearestNanosecond) {
  EXPECT_EQ(seconds(1.5), Duration(1'500'000'000));
  EXPECT_EQ(seconds(0.1), Duration(100'000'000));
  EXPECT_EQ(seconds(1e-9 * 0.6), Duration(1));
  EXPECT_EQ(seconds(1e-9 * 0.4), Duration(0));
  EXPECT_EQ(seconds(-0.25), Duration(-250'000'000));
}

TEST(Time, WholeNanosecondsSurviveSeconds) {
  for (const std::int64_t ns : {0LL, 1LL, 999'999'999LL, 123'456'789'012LL, 86'400'000'000'001LL, -7LL}) {
    EXPECT_EQ(seconds(to_seconds(Duration(ns))), Duration(ns));
    EXPECT_EQ(instant_at(to_seconds(Instant(Duration(ns)))), Instant(Duration(ns)));
  }
}

TEST(Time, UnitsAreNanoseconds) {
  EXPECT_EQ(milliseconds(3), Duration(3'000'000));
  EXPECT_EQ(microseconds(3), Duration(3'000));
  EXPECT_EQ(kStart + milliseconds(1), instant_at(0.001));
  EXPECT_LT(instant_at(9e9), kNever);
}

}  // namespace
}  // namespace footlight
