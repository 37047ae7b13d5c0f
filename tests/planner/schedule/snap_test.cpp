// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/snap.hpp"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"
#include "tests/support/plan_builder.hpp"

namespace footlight::planner {
namespace {

TEST(Snap, WhoCanReachTheOwnCellStandsOnItAndWhoCannotComesNear) {
  Stage stage;
  stage.grid = *Grid::make(GridKind::square, 30, 3, 1.0);
  const Ways ways(stage, 0.25);
  const std::vector<CellIndex> now{CellIndex(0), CellIndex(1)};
  const std::vector<CellIndex> own{CellIndex(20), CellIndex(3)};
  const std::vector<Wanted> wanted{{stage.grid.centre(own[0]), true}, {stage.grid.centre(own[1]), true}};
  const auto next = snap({&ways, now, own, wanted, {}, 4.0, 0.0, {}});
  EXPECT_EQ(next[1], own[1]);
  // 3.25 m along the way is nearest to column 3, which is taken.
  EXPECT_EQ(next[0], CellIndex(4));
}

TEST(Snap, WhoHoldsStaysAndTheOwnerOfThatCellGivesWay) {
  Stage stage;
  stage.grid = *Grid::make(GridKind::square, 30, 3, 1.0);
  const Ways ways(stage, 0.25);
  const std::vector<CellIndex> now{CellIndex(2), CellIndex(1)};
  const std::vector<CellIndex> own{CellIndex(4), CellIndex(2)};
  const std::vector<Wanted> wanted{{stage.grid.centre(own[0]), true}, {stage.grid.centre(own[1]), true}};
  const std::vector<char> hold{1, 0};
  const auto next = snap({&ways, now, own, wanted, {}, 4.0, 0.0, hold});
  EXPECT_EQ(next[0], CellIndex(2));
  EXPECT_NE(next[1], CellIndex(2));
}

TEST(Snap, EverybodyGetsACellOfTheirOwnWithinReach) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    Stage stage;
    stage.grid = *Grid::make(static_cast<GridKind>(rng.below(3)), 12, 10, 1.0);
    for (int i = 0; i < stage.grid.size(); ++i) {
      if (rng.below(15) == 0) stage.blocked.push_back(CellIndex::of(i));
    }
    const Ways ways(stage, 0.25);
    std::vector<CellIndex> free;
    for (int i = 0; i < stage.grid.size(); ++i) {
      if (ways.can_stand(CellIndex::of(i))) free.push_back(CellIndex::of(i));
    }
    const std::size_t people = 1 + rng.below(free.size());
    const auto now = tests::random_cells(free, people, rng);
    const auto own = tests::random_cells(free, people, rng);
    std::vector<Wanted> wanted;
    for (const CellIndex cell : own) wanted.push_back({stage.grid.centre(cell), rng.below(4) != 0});
    const double longest_m = 4 * rng.uniform();
    const auto next = snap({&ways, now, own, wanted, {}, longest_m, 0.0, {}});
    RC_ASSERT(std::set<CellIndex>(next.begin(), next.end()).size() == people);
    for (std::size_t i = 0; i < people; ++i) {
      RC_ASSERT(ways.can_stand(next[i]));
      const Point from = stage.grid.centre(now[i]);
      const Point to = stage.grid.centre(next[i]);
      RC_ASSERT(distance(from, to) <= longest_m || next[i] == now[i]);
      RC_ASSERT(next[i] == now[i] || ways.straight(from, to));
    }
  }));
}

}  // namespace
}  // namespace footlight::planner
