// SPDX-License-Identifier: Apache-2.0
#include "controller/time/time_follower.hpp"

#include <gtest/gtest.h>

#include "core/rng.hpp"

namespace footlight::controller {
namespace {

using State = TimeFollower::State;

/// A source that says at every 40 ms where it is.
struct Source {
  void run(double time_s, double rate = 1) {
    for (const Instant end = now + seconds(time_s); now < end; now += milliseconds(40)) {
      follower.take({now, position});
      position += seconds(0.04 * rate);
    }
  }
  void silence(double time_s, double rate = 1) {
    now += seconds(time_s);
    position += seconds(time_s * rate);
  }
  [[nodiscard]] double off_ms() const { return to_seconds(*follower.position(now) - position) * 1e3; }

  TimeFollower follower{milliseconds(2000)};
  Instant now = instant_at(50);
  Duration position = seconds(3600);
};

TEST(TimeFollower, LocksAfterThreeWordsThatMakeSense) {
  Source source;
  EXPECT_EQ(source.follower.state(source.now), State::none);
  source.run(0.08);
  EXPECT_EQ(source.follower.state(source.now), State::none);
  source.run(0.04);
  EXPECT_EQ(source.follower.state(source.now), State::locked);
  EXPECT_LT(std::abs(source.off_ms()), 0.1);
}

TEST(TimeFollower, KnowsTheSpeedOfATapeAndKeepsItThroughAGap) {
  Source source;
  source.run(2, 1.06);
  EXPECT_NEAR(source.follower.rate(), 1.06, 1e-3);
  source.silence(1, 1.06);
  EXPECT_EQ(source.follower.state(source.now), State::freewheels);
  EXPECT_LT(std::abs(source.off_ms()), 5);
  source.run(0.04, 1.06);
  EXPECT_EQ(source.follower.state(source.now), State::locked) << "one word is enough where it was expected";
}

TEST(TimeFollower, IsLostAfterTwoSecondsOfSilence) {
  Source source;
  source.run(1);
  source.silence(2.1);
  EXPECT_EQ(source.follower.state(source.now), State::lost);
}

TEST(TimeFollower, OneWrongWordIsNoJumpThreeAre) {
  Source source;
  source.run(1);
  source.follower.take({source.now, seconds(10)});
  source.run(0.04);
  EXPECT_EQ(source.follower.jumps(), 0U);
  EXPECT_LT(std::abs(source.off_ms()), 1);
  source.position += seconds(20);
  source.run(0.08);
  EXPECT_EQ(source.follower.jumps(), 0U);
  source.run(0.04);
  EXPECT_EQ(source.follower.jumps(), 1U);
  EXPECT_LT(std::abs(source.off_ms()), 1);
}

TEST(TimeFollower, GarbageIsNeverLocked) {
  Rng rng(3);
  TimeFollower follower{milliseconds(2000)};
  Instant now = instant_at(50);
  for (int i = 0; i < 10'000; ++i, now += milliseconds(40)) {
    follower.take({now, seconds(static_cast<double>(rng.below(86'400)))});
    ASSERT_EQ(follower.state(now), State::none) << i;
  }
}

TEST(TimeFollower, ATapeThatRunsBackwardsIsNotFollowed) {
  Source source;
  source.run(1, -1);
  EXPECT_EQ(source.follower.state(source.now), State::none);
}

TEST(TimeFollower, ASourceThatStandsStillIsLost) {
  Source source;
  source.run(1);
  source.run(0.5, 0);
  EXPECT_EQ(source.follower.state(source.now), State::freewheels);
  source.run(2, 0);
  EXPECT_EQ(source.follower.state(source.now), State::lost);
  EXPECT_EQ(source.follower.jumps(), 0U);
}

TEST(TimeFollower, WhenWordsComeEarlyAndLateThePlaceIsStillKnownToAFewMilliseconds) {
  Rng rng(9);
  TimeFollower follower{milliseconds(2000)};
  double worst_ms = 0;
  for (int i = 0; i < 500; ++i) {
    const Duration truth = seconds(0.04 * i * 1.01);
    follower.take({instant_at(50 + 0.04 * i + 0.02 * rng.uniform()), truth});
    if (i < 100) continue;
    const double off_s = to_seconds(*follower.position(instant_at(50 + 0.04 * i + 0.01)) - truth);
    worst_ms = std::max(worst_ms, std::abs(off_s) * 1e3);
  }
  EXPECT_LT(worst_ms, 8);
  EXPECT_NEAR(follower.rate(), 1.01, 0.02);
}

}  // namespace
}  // namespace footlight::controller
