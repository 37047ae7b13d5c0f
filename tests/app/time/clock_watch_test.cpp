// SPDX-License-Identifier: Apache-2.0
#include "app/time/clock_watch.hpp"

#include <gtest/gtest.h>

#include "core/boot_time.hpp"
#include "core/clock.hpp"

namespace footlight::app {
namespace {

/// The machine's three clocks.
struct Machine {
  std::optional<ClockWatch::News> run(double time_s) {
    steady += seconds(time_s);
    boot += seconds(time_s);
    wall += seconds(time_s);
    return watch.take(steady, boot, wall);
  }
  ClockWatch watch;
  Instant steady = instant_at(5);
  Duration boot = seconds(90'000);
  Duration wall = seconds(1.7e9);
};

TEST(ClockWatch, NothingHappensIsNoNews) {
  Machine machine;
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(machine.run(i == 50 ? 30 : 0.02));
}

TEST(ClockWatch, SeesThatTheMachineHasSlept) {
  Machine machine;
  machine.run(1);
  machine.boot += seconds(12);
  machine.wall += seconds(12);
  const auto news = machine.run(0.02);
  ASSERT_TRUE(news);
  EXPECT_EQ(news->kind, ClockWatch::Kind::slept);
  EXPECT_EQ(news->by, seconds(12));
  EXPECT_FALSE(machine.run(0.02)) << "once";
}

TEST(ClockWatch, AStepOfTheWallClockIsNoSleep) {
  Machine machine;
  machine.run(1);
  for (const double step_s : {3600.0, -1.0, 0.6}) {
    machine.wall += seconds(step_s);
    const auto news = machine.run(0.02);
    ASSERT_TRUE(news);
    EXPECT_EQ(news->kind, ClockWatch::Kind::stepped);
    EXPECT_EQ(news->by, seconds(step_s));
  }
  machine.wall += milliseconds(20);
  EXPECT_FALSE(machine.run(0.02)) << "what keeps clocks right does so in small steps";
}

TEST(ClockWatch, TheClocksOfThisMachineGoTogether) {
  const SteadyClock steady;
  ClockWatch watch;
  for (int i = 0; i < 1000; ++i) EXPECT_FALSE(watch.take(steady.now(), boot_time(), wall_time()));
}

}  // namespace
}  // namespace footlight::app
