// SPDX-License-Identifier: Apache-2.0
#include "sim/world.hpp"

#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace footlight::sim {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;

class Diary final : public Actor {
 public:
  explicit Diary(World& world) : world_(world) {}
  void act(std::uint64_t token) override {
    entries.emplace_back(world_.now().time_since_epoch().count(), token);
    if (token == 7) world_.schedule(world_.now(), *this, 8);
  }
  std::vector<std::pair<Duration::rep, std::uint64_t>> entries;

 private:
  World& world_;
};

Instant at(Duration::rep nanoseconds) { return Instant(Duration(nanoseconds)); }

TEST(World, EventsHappenByInstantAndThenInTheOrderOfScheduling) {
  ManualClock clock;
  World world(clock);
  Diary diary(world);
  world.schedule(at(5), diary, 1);
  world.schedule(at(3), diary, 2);
  world.schedule(at(5), diary, 3);
  world.schedule(at(3), diary, 4);
  EXPECT_EQ(world.next(), at(3));
  world.advance_to(at(5));
  EXPECT_THAT(diary.entries, ElementsAre(Pair(3, 2), Pair(3, 4), Pair(5, 1), Pair(5, 3)));
  EXPECT_EQ(world.next(), kNever);
}

TEST(World, WhatAnEventBringsAboutAtTheSameInstantHappensInTheSameAdvance) {
  ManualClock clock;
  World world(clock);
  Diary diary(world);
  world.schedule(at(5), diary, 7);
  world.schedule(at(5), diary, 9);
  world.advance_to(at(5));
  EXPECT_THAT(diary.entries, ElementsAre(Pair(5, 7), Pair(5, 9), Pair(5, 8)));
}

TEST(World, TheClockStopsAtTheInstantAskedForAndLaterEventsWait) {
  ManualClock clock;
  World world(clock);
  Diary diary(world);
  world.schedule(at(11), diary, 1);
  world.advance_to(at(10));
  EXPECT_EQ(clock.now(), at(10));
  EXPECT_TRUE(diary.entries.empty());
  EXPECT_EQ(world.next(), at(11));
}

}  // namespace
}  // namespace footlight::sim
