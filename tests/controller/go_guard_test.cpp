// SPDX-License-Identifier: Apache-2.0
#include "controller/go_guard.hpp"

#include <gtest/gtest.h>

namespace footlight::controller {
namespace {

using Verdict = GoGuard::Verdict;
constexpr Duration kLeast = milliseconds(1000);

TEST(GoGuard, ABouncingPressIsOneGo) {
  for (int bounce_ms = 1; bounce_ms <= 20; ++bounce_ms) {
    GoGuard guard(kLeast);
    int taken = 0;
    for (Instant now = instant_at(3); now < instant_at(3.02); now += milliseconds(bounce_ms)) {
      taken += guard.press(GoSource::lines, 1, now) == Verdict::taken ? 1 : 0;
    }
    EXPECT_EQ(taken, 1) << bounce_ms;
  }
}

TEST(GoGuard, TwoPeopleWhoPressAtOnceAreOneGo) {
  GoGuard guard(kLeast);
  EXPECT_EQ(guard.press(GoSource::keyboard, 0, instant_at(1)), Verdict::taken);
  EXPECT_EQ(guard.press(GoSource::lines, 1, instant_at(1.9)), Verdict::too_soon);
  EXPECT_EQ(guard.press(GoSource::lines, 1, instant_at(2)), Verdict::taken);
}

TEST(GoGuard, AKeyThatIsHeldCountsOnceUntilItHasBeenUp) {
  GoGuard guard(kLeast);
  EXPECT_EQ(guard.press(GoSource::keyboard, 0, instant_at(1)), Verdict::taken);
  Instant now = instant_at(1.66);  // the first repeat of a keyboard, then thirty a second
  for (; now < instant_at(4); now += milliseconds(33))
    EXPECT_EQ(guard.press(GoSource::keyboard, 0, now), Verdict::held);
  EXPECT_EQ(guard.press(GoSource::keyboard, 0, now + kLeast), Verdict::taken);
}

TEST(GoGuard, AStuckKeyIsSwitchedOffAfterFiveSecondsAndTheOthersLive) {
  GoGuard guard(kLeast);
  Instant now = instant_at(1);
  for (; now <= instant_at(6); now += milliseconds(50)) guard.press(GoSource::keyboard, 0, now);
  EXPECT_EQ(guard.off(), 0U);
  EXPECT_EQ(guard.press(GoSource::keyboard, 0, now), Verdict::switched_off);
  EXPECT_EQ(guard.off(), 1U);
  EXPECT_EQ(guard.press(GoSource::lines, 1, now), Verdict::taken);
  EXPECT_EQ(guard.press(GoSource::keyboard, 0, now + milliseconds(60'000)), Verdict::switched_off);
  guard.acknowledge();
  EXPECT_EQ(guard.press(GoSource::keyboard, 0, now + milliseconds(62'000)), Verdict::taken);
}

TEST(GoGuard, OneThatFloodsIsSwitchedOffAndAnotherOneOfItsKindIsHeard) {
  GoGuard guard(kLeast);
  Instant now = instant_at(1);
  for (; now <= instant_at(7); now += milliseconds(1)) guard.press(GoSource::network, 4, now);
  EXPECT_EQ(guard.off(), 1U << 4U);
  EXPECT_EQ(guard.press(GoSource::network, 4, now + kLeast), Verdict::switched_off);
  EXPECT_EQ(guard.press(GoSource::network, 5, now + kLeast), Verdict::taken);
  EXPECT_EQ(guard.press(GoSource::network, 63, now + kLeast * 2), Verdict::taken) << "the last number";
}

}  // namespace
}  // namespace footlight::controller
