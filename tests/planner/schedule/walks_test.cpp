// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/walks.hpp"

#include <algorithm>
#include <atomic>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"
#include "planner/repair/closest_approach.hpp"
#include "planner/schedule/step.hpp"
#include "tests/planner/random_places.hpp"

namespace footlight::planner {
namespace {

std::vector<Walk> walks_of(const Grid& grid, const std::vector<CellIndex>& from, const std::vector<CellIndex>& to,
                           const Leg& leg) {
  std::vector<Walk> walks;
  for (std::size_t i = 0; i < from.size(); ++i) {
    walks.push_back({grid.centre(from[i]), grid.centre(to[leg.target_of[i]])});
  }
  return walks;
}

TEST(Settle, PeopleWhoWouldCrossExchangeTheirTargets) {
  Stage stage;
  stage.grid = *Grid::make(GridKind::square, 10, 2, 1.0);
  const Ways ways(stage, 0.25);
  const std::vector<CellIndex> from{CellIndex(0), CellIndex(5)};
  const std::vector<CellIndex> to{CellIndex(6), CellIndex(1)};
  const Leg leg = settle({&ways, from, to, 9, 0.5});
  EXPECT_EQ(leg.target_of, (std::vector<std::uint32_t>{1, 0}));
  EXPECT_TRUE(leg.walkable);
  EXPECT_TRUE(leg.conflicts.empty());
}

TEST(Settle, TargetsTooFarForTheirPeopleAreHandedOutAnew) {
  Stage stage;
  stage.grid = *Grid::make(GridKind::square, 10, 2, 1.0);
  const Ways ways(stage, 0.25);
  const std::vector<CellIndex> from{CellIndex(0), CellIndex(3), CellIndex(6)};
  const std::vector<CellIndex> to{CellIndex(9), CellIndex(3), CellIndex(6)};
  const Leg leg = settle({&ways, from, to, 3.5, 0.5});
  EXPECT_TRUE(leg.walkable);
  EXPECT_EQ(leg.target_of, (std::vector<std::uint32_t>{1, 2, 0}));
  EXPECT_FALSE(settle({&ways, from, to, 2.5, 0.5}).walkable);
}

TEST(Settle, WhoHasBeenStoppedKeepsHerTarget) {
  Stage stage;
  stage.grid = *Grid::make(GridKind::square, 10, 2, 1.0);
  const Ways ways(stage, 0.25);
  const std::vector<CellIndex> from{CellIndex(0), CellIndex(5)};
  const std::vector<CellIndex> to{CellIndex(6), CellIndex(1)};
  const std::atomic<bool> stopped = true;
  LegTask task{&ways, from, to, 9, 0.5};
  task.stop = &stopped;
  EXPECT_EQ(settle(task).target_of, (std::vector<std::uint32_t>{0, 1}));
}

TEST(WalkStep, WhatWasStoppedIsNotKeptAsAStage) {
  Stage stage;
  stage.grid = *Grid::make(GridKind::square, 10, 2, 1.0);
  const Ways ways(stage, 0.25);
  const std::vector<CellIndex> now{CellIndex(0), CellIndex(5)};
  const std::vector<CellIndex> own{CellIndex(6), CellIndex(1)};
  std::atomic<bool> stopped = true;
  StepTask task;
  task.snap.ways = &ways;
  task.snap.now = now;
  task.snap.own = own;
  task.snap.longest_m = 9;
  task.exact = true;
  task.walked_s = 9;
  task.stop = &stopped;
  Stages stages;
  (void)walk_step(task, {}, &stages, nullptr);
  EXPECT_EQ(stages.size(), 0U);
  stopped = false;
  EXPECT_EQ(walk_step(task, {}, &stages, nullptr).leg.target_of, (std::vector<std::uint32_t>{1, 0}));
  EXPECT_EQ(stages.size(), 1U);
}

TEST(Settle, SaysWhoIsTooCloseWhereNothingHelps) {
  Stage stage;
  stage.grid = *Grid::make(GridKind::square, 4, 4, 1.0);
  const Ways ways(stage, 0.25);
  // Diagonal moves around a corner: nearer than 0.9 m whatever the pairing.
  const std::vector<CellIndex> from{stage.grid.index({0, 0}), stage.grid.index({1, 0})};
  const std::vector<CellIndex> to{stage.grid.index({1, 1}), stage.grid.index({1, 2})};
  const Leg leg = settle({&ways, from, to, 9, 0.95});
  ASSERT_EQ(leg.conflicts.size(), 1U);
  EXPECT_EQ(leg.conflicts.front(), std::pair(0U, 1U));
}

TEST(Settle, OnlyPeopleOfOneKindExchangeTheirTargets) {
  Stage stage;
  stage.grid = *Grid::make(GridKind::square, 10, 2, 1.0);
  const Ways ways(stage, 0.25);
  const std::vector<CellIndex> from{CellIndex(0), CellIndex(5), CellIndex(10), CellIndex(15)};
  const std::vector<CellIndex> to{CellIndex(6), CellIndex(1), CellIndex(16), CellIndex(11)};
  const std::vector<std::uint32_t> kind{1, 2, 3, 3};
  const Leg leg = settle({&ways, from, to, 9, 0.5, kind});
  EXPECT_EQ(leg.target_of, (std::vector<std::uint32_t>{0, 1, 3, 2}));
  EXPECT_EQ(leg.conflicts, (std::vector<std::pair<std::uint32_t, std::uint32_t>>{{0, 1}}));
}

TEST(Settle, TargetsTooFarAreHandedOutAnewWithinTheirKind) {
  Stage stage;
  stage.grid = *Grid::make(GridKind::square, 10, 2, 1.0);
  const Ways ways(stage, 0.25);
  const std::vector<CellIndex> from{CellIndex(0), CellIndex(3), CellIndex(6), CellIndex(10)};
  const std::vector<CellIndex> to{CellIndex(9), CellIndex(3), CellIndex(6), CellIndex(12)};
  const std::vector<std::uint32_t> one{0, 0, 0, 1};
  const Leg leg = settle({&ways, from, to, 3.5, 0.5, one});
  EXPECT_TRUE(leg.walkable);
  EXPECT_EQ(leg.target_of, (std::vector<std::uint32_t>{1, 2, 0, 3}));
  const std::vector<std::uint32_t> alone{0, 1, 1, 2};
  EXPECT_FALSE(settle({&ways, from, to, 3.5, 0.5, alone}).walkable) << "the one who walks too far cannot be relieved";
}

TEST(Settle, NobodyEverTakesATargetOfAnotherKind) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    Stage stage;
    stage.grid = *Grid::make(static_cast<GridKind>(rng.below(3)), 10, 9, 1.0);
    if (rng.below(2) == 0) stage.blocked = {CellIndex(44)};
    const Ways ways(stage, 0.25);
    const std::size_t people = 1 + rng.below(60);
    const auto from = random_places(ways, people, rng);
    const auto to = random_places(ways, people, rng);
    const auto kind = random_kinds(people, rng);
    const Leg leg = settle({&ways, from, to, 2.0 + 8 * rng.uniform(), 0.5, kind});
    std::vector<std::uint32_t> order = leg.target_of;
    for (std::uint32_t i = 0; i < people; ++i) RC_ASSERT(kind[leg.target_of[i]] == kind[i]);
    std::sort(order.begin(), order.end());
    for (std::uint32_t i = 0; i < people; ++i) RC_ASSERT(order[i] == i);
  }));
}

TEST(Settle, WithoutALimitNobodyEverComesNearerThanTheBound) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    Stage stage;
    stage.grid = *Grid::make(static_cast<GridKind>(rng.below(3)), 10, 9, 1.0);
    const Ways ways(stage, 0.25);
    const std::size_t people = 1 + rng.below(80);
    const auto from = random_places(ways, people, rng);
    const auto to = random_places(ways, people, rng);
    const Leg leg = settle({&ways, from, to, 1e9, 0.5});
    RC_ASSERT(leg.conflicts.empty());
    RC_ASSERT(near_pairs(walks_of(stage.grid, from, to, leg), stage.grid.clearance_bound_m() - 1e-9).empty());
  }));
}

}  // namespace
}  // namespace footlight::planner
