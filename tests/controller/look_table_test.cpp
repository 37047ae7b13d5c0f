// SPDX-License-Identifier: Apache-2.0
#include "controller/look_table.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

namespace footlight::controller {
namespace {

Look look(int red) { return {{static_cast<std::uint8_t>(red), 1, 0}, Effect::steady, 255}; }

/// One node whose channels show these looks, four a switch, and a table of the looks in this order.
CueSchedule schedule_of(const std::vector<int>& reds, const std::vector<LookIndex>& shown, std::uint8_t byte) {
  std::vector<Look> looks{{{0, 0, 0}, Effect::steady, 0}};
  for (const int red : reds) looks.push_back(look(red));
  std::vector<Switch> switches(1 + shown.size() / 4);
  for (std::size_t k = 0; k < switches.size(); ++k) switches[k].time = instant_at(static_cast<double>(k));
  std::vector<LookIndex> table(switches.size() * kChannelsPerNode, kDark);
  for (std::size_t i = 0; i < shown.size(); ++i) table[i / 4 * kChannelsPerNode + i % 4] = shown[i];
  return {std::move(looks), std::move(switches), 1, std::move(table), byte, {}};
}

Look shown(const CueSchedule& schedule, std::size_t k, std::size_t channel) {
  return schedule.looks()[schedule.looks_of(k, NodeIndex(0))[channel]];
}

TEST(LookTable, ALookThatBothSchedulesHaveKeepsItsNumber) {
  const CueSchedule before = schedule_of({10, 20, 30}, {1, 2, 3, 1}, 7);
  const auto now = numbered_after(schedule_of({5, 20, 30}, {1, 2, 3, 0}, 8), before, 254);
  ASSERT_TRUE(now) << now.error().message;
  EXPECT_EQ(now->looks(), (std::vector<Look>{before.looks()[0], look(10), look(20), look(30), look(5)}));
  EXPECT_EQ(now->looks_of(0, NodeIndex(0))[0], 4);
  EXPECT_EQ(now->looks_of(0, NodeIndex(0))[1], 2);
  EXPECT_EQ(now->plan_byte(), 8);
}

TEST(LookTable, ANewLookTakesTheNumberOfOneThatNoLampCanShow) {
  const CueSchedule before = schedule_of({10, 20, 30}, {1, 3, 3, 1}, 7);
  const auto now = numbered_after(schedule_of({5, 30}, {1, 2, 0, 0}, 7), before, 3);
  ASSERT_TRUE(now) << now.error().message;
  EXPECT_EQ(now->looks(), (std::vector<Look>{before.looks()[0], look(10), look(5), look(30)}));
  EXPECT_EQ(now->plan_byte(), 8) << "no latch of this plan takes what was preloaded for the other";
}

TEST(LookTable, MoreLooksThanTheMarkersHoldAreRefused) {
  const CueSchedule before = schedule_of({10, 20}, {1, 2, 0, 0}, 7);
  const auto now = numbered_after(schedule_of({5, 6}, {1, 2, 0, 0}, 8), before, 3);
  ASSERT_FALSE(now);
  EXPECT_EQ(now.error().kind, ErrorKind::refused);
  EXPECT_EQ(
      now.error().message,
      "the looks of the plan that runs and of the new one are 4 together, and the markers know 3 at a time (fewer "
      "new colours, or end the run and start it again)");
}

TEST(LookTable, OneChangeAfterTheOtherNoLampChangesItsLookByIt) {
  EXPECT_TRUE(rc::check("numbers are only another name", [] {
    const auto any = [] {
      auto reds = *rc::gen::unique<std::vector<int>>(rc::gen::inRange(0, 60));
      const auto most = static_cast<int>(reds.size());
      std::vector<LookIndex> shown;
      for (const int i : *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, most + 1)))
        shown.push_back(static_cast<LookIndex>(i));
      return schedule_of(reds, shown, static_cast<std::uint8_t>(*rc::gen::inRange(0, 3)));
    };
    CueSchedule before = any();
    for (int round = 0; round < 5; ++round) {
      CueSchedule plain = any();
      std::vector<std::vector<Look>> wanted;
      for (std::size_t k = 0; k < plain.switches().size(); ++k) {
        auto& row = wanted.emplace_back();
        for (std::size_t c = 0; c < 4; ++c) row.push_back(shown(plain, k, c));
      }
      auto now = numbered_after(std::move(plain), before, 254);
      RC_ASSERT(now);
      for (std::size_t k = 0; k < wanted.size(); ++k) {
        for (std::size_t c = 0; c < 4; ++c) RC_ASSERT(shown(*now, k, c) == wanted[k][c]);
      }
      const auto lit = before.numbers_shown();
      for (std::size_t i = 0; i < lit.size(); ++i) {
        if (lit[i]) RC_ASSERT(now->looks()[i] == before.looks()[i]);
      }
      RC_ASSERT(now->plan_byte() != before.plan_byte());
      before = std::move(now).value();
    }
  }));
}

}  // namespace
}  // namespace footlight::controller
