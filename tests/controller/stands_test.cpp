// SPDX-License-Identifier: Apache-2.0
#include "controller/stands.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "tests/support/plan_builder.hpp"

namespace footlight::controller {
namespace {

using tests::mark_at;

/// One walks in [0, 2] and [2, 4] s, waits until 6 and walks until 8; the other walks in [1, 2] and [6.5, 7] s.
Plan two_people() {
  const Grid grid = Grid::make(GridKind::square, 8, 4, 1.0).value();
  return tests::plan_of(grid, {{mark_at(0, grid, 0, 0), mark_at(2, grid, 1, 0), mark_at(4, grid, 2, 0),
                                mark_at(6, grid, 2, 0), mark_at(8, grid, 3, 0)},
                               {mark_at(0, grid, 0, 2), mark_at(1, grid, 0, 2), mark_at(2, grid, 1, 2),
                                mark_at(6.5, grid, 1, 2), mark_at(7, grid, 2, 2), mark_at(8, grid, 2, 2)}});
}

TEST(Stands, AHoldGoesOnToTheInstantAtWhichEverybodyStands) {
  const Stands stands(two_people());
  EXPECT_EQ(stands.from(instant_at(0.5), false), instant_at(2)) << "there both are on a cell, though one walks on";
  EXPECT_EQ(stands.from(instant_at(2), false), instant_at(4)) << "the walk of that instant has begun";
  EXPECT_EQ(stands.from(instant_at(2), true), instant_at(2));
  EXPECT_EQ(stands.from(instant_at(5), false), instant_at(5));
  EXPECT_EQ(stands.from(instant_at(6.9), false), instant_at(8));
  EXPECT_EQ(stands.from(instant_at(8), false), instant_at(8));
}

TEST(Stands, AJumpIntoAWalkGoesToItsBeginning) {
  const Stands stands(two_people());
  EXPECT_EQ(stands.until(instant_at(3)), instant_at(2));
  EXPECT_EQ(stands.until(instant_at(2)), instant_at(2));
  EXPECT_EQ(stands.until(instant_at(5)), instant_at(5));
  EXPECT_EQ(stands.until(instant_at(7.5)), instant_at(6));
}

TEST(Stands, ARestIsAsLongAsNobodyWalksAndKnowsTheShortestWalkBehindIt) {
  const Stands stands(two_people());
  EXPECT_EQ(stands.rest(instant_at(0))->stands, Duration{});
  EXPECT_EQ(stands.rest(instant_at(0))->shortest_walk, seconds(1)) << "the other one walks from 1 to 2 s";
  EXPECT_EQ(stands.rest(instant_at(4.5))->stands, seconds(1.5));
  EXPECT_EQ(stands.rest(instant_at(4.5))->shortest_walk, seconds(0.5));
  EXPECT_FALSE(stands.rest(instant_at(8)));
}

TEST(Stands, CellsAreThoseOfEverybody) {
  const Plan plan = two_people();
  const auto cell = [&](int column, int row) { return plan.stage.grid.index({column, row}); };
  EXPECT_THAT(cells_at(plan, instant_at(5)), testing::ElementsAre(cell(2, 0), cell(1, 2)));
  EXPECT_THAT(cells_at(plan, instant_at(2)), testing::ElementsAre(cell(1, 0), cell(1, 2)));
}

TEST(Stands, WhereItSaysThatEverybodyStandsEverybodyDoes) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint64_t>());
    const Grid grid = Grid::make(GridKind::square, 6, 6, 1.0).value();
    const Plan plan = tests::random_plan(grid, 4, 6, true, rng);
    const Stands stands(plan);
    const Instant at = instant_at(static_cast<double>(rng.below(10'000)) / 1000);
    const bool waits = rng.below(2) == 0;
    const Instant from = stands.from(at, waits);
    RC_ASSERT(from >= at);
    RC_ASSERT(stands.until(at) <= at);
    for (const Instant stand : {from, stands.until(at)}) RC_ASSERT(cells_at(plan, stand).size() == 4U);
    RC_ASSERT(stands.from(from, true) == from);
    RC_ASSERT(stands.until(from) == from);
  }));
}

}  // namespace
}  // namespace footlight::controller
