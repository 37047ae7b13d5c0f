// SPDX-License-Identifier: Apache-2.0
#include "controller/patterns.hpp"

#include <algorithm>

#include <gtest/gtest.h>
#include <rapidcheck.h>

namespace footlight::controller {
namespace {

TEST(NearGoals, PeopleWhoAreNeverNearEachOtherHaveTheFirstPattern) {
  NearGoals near(4);
  EXPECT_EQ(near.patterns(4), (std::vector<std::uint8_t>{0, 0, 0, 0}));
}

TEST(NearGoals, ARowOfPeopleNeedsTwoPatterns) {
  NearGoals near(6);
  for (std::uint32_t p = 0; p + 1 < 6; ++p) near.add(PerformerIndex(p), PerformerIndex(p + 1));
  const auto patterns = near.patterns(4);
  for (std::size_t p = 0; p + 1 < 6; ++p) EXPECT_NE(patterns[p], patterns[p + 1]);
  EXPECT_LE(*std::ranges::max_element(patterns), 1);
}

TEST(NearGoals, WithTooFewPatternsTheRarestMeetingShares) {
  NearGoals near(3);
  for (int i = 0; i < 5; ++i) near.add(PerformerIndex(0), PerformerIndex(1));
  for (int i = 0; i < 4; ++i) near.add(PerformerIndex(1), PerformerIndex(2));
  near.add(PerformerIndex(2), PerformerIndex(0));
  const auto patterns = near.patterns(2);
  EXPECT_EQ(patterns[0], patterns[2]);
  EXPECT_NE(patterns[0], patterns[1]);
}

TEST(NearGoals, NoPerformerGainsByChangingHerPatternAlone) {
  EXPECT_TRUE(rc::check([] {
    const auto people = *rc::gen::inRange<std::uint32_t>(2, 12);
    const auto number = *rc::gen::inRange(1, 5);
    const auto meetings = *rc::gen::container<std::vector<std::pair<std::uint32_t, std::uint32_t>>>(
        rc::gen::pair(rc::gen::inRange<std::uint32_t>(0, people), rc::gen::inRange<std::uint32_t>(0, people)));
    NearGoals near(people);
    for (const auto& [a, b] : meetings) {
      if (a != b) near.add(PerformerIndex(a), PerformerIndex(b));
    }
    const auto patterns = near.patterns(number);
    std::uint64_t shared = 0;
    std::uint64_t all = 0;
    for (const auto& [a, b] : meetings) {
      if (a == b) continue;
      ++all;
      shared += patterns[a] == patterns[b] ? 1 : 0;
    }
    // What the pigeonhole promises of a state that no single change improves.
    RC_ASSERT(shared * static_cast<std::uint64_t>(number) <= all);
  }));
}

}  // namespace
}  // namespace footlight::controller
