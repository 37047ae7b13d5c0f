// SPDX-License-Identifier: Apache-2.0
#include "app/reset_way.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "controller/stands.hpp"
#include "planner/validate.hpp"
#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

tests::SmallShow any_show(std::uint64_t seed) {
  tests::SmallShow small = tests::random_show(12, 8, 12, 2, 2, seed);
  small.show.stage.max_speed_mps = 1.4;
  small.show.stage.lag = {};
  for (PlanSection& section : small.plan.sections) section.max_speed_mps = 1.4;
  small.plan.stage = small.show.stage;
  return small;
}

const std::atomic<bool> kGoOn{false};

TEST(ResetWay, LeadsEverybodyFromWhereTheyStandToWhereTheyMustBeAndIsProved) {
  EXPECT_TRUE(rc::check([] {
    const tests::SmallShow small = any_show(*rc::gen::arbitrary<std::uint64_t>());
    const Instant from = instant_at(4);
    const Instant to = instant_at(2);
    const auto way = plan_reset_way(small.show, small.plan, from, to, 4, kGoOn);
    if (!way) RC_DISCARD("refused");
    const auto cells = controller::cells_at(small.plan, from);
    const auto goals = controller::cells_at(small.plan, to);
    for (std::size_t p = 0; p < way->tracks.size(); ++p) {
      const auto& track = way->tracks[p];
      RC_ASSERT(track.front().cell == cells[p]);
      RC_ASSERT(track.front().time == kStart);
      RC_ASSERT(track.back().cell == goals[p]);
      for (const Mark& mark : track) RC_ASSERT(mark.time > instant_at(1.999) || mark.cell == cells[p]);
    }
    const planner::Verdict verdict = planner::validate(*way);
    RC_ASSERT(verdict.valid());
    RC_ASSERT(verdict.max_speed_mps <= 1.4 * (1 + 1e-6));
  }));
}

TEST(ResetWay, KeepsToTheSlowerOfTheTwoSections) {
  tests::SmallShow small = any_show(3);
  small.plan.sections[1].max_speed_mps = 0.7;
  const auto way = plan_reset_way(small.show, small.plan, instant_at(12), instant_at(0), 4, kGoOn);
  ASSERT_TRUE(way) << way.error().message;
  EXPECT_LE(planner::validate(*way).max_speed_mps, 0.7 * (1 + 1e-6));
}

TEST(ResetWay, AWayThatIsGivenUpIsNoWay) {
  const tests::SmallShow small = any_show(3);
  const std::atomic<bool> abandoned{true};
  const auto way = plan_reset_way(small.show, small.plan, instant_at(4), instant_at(0), 4, abandoned);
  ASSERT_FALSE(way);
  EXPECT_EQ(way.error().kind, ErrorKind::interrupted);
}

}  // namespace
}  // namespace footlight::app
