// SPDX-License-Identifier: Apache-2.0
#include "planner/repair/tolerance.hpp"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"
#include "tests/support/plan_builder.hpp"

namespace footlight::planner {
namespace {

/// People on a square floor of 1 m, walks of three seconds at up to 1.4 m/s, 0.2 s late.
struct Floor {
  Grid grid = *Grid::make(GridKind::square, 16, 12, 1.0);
  std::vector<CellIndex> from;
  std::vector<CellIndex> to;
  std::vector<std::uint32_t> target_of;
  std::vector<std::uint32_t> kind;
  MayWalk may_walk = [](Point a, Point b) { return distance(a, b) <= 4.2; };

  void walk(Cell start, Cell goal) {
    from.push_back(grid.index(start));
    to.push_back(grid.index(goal));
    target_of.push_back(static_cast<std::uint32_t>(target_of.size()));
  }
  [[nodiscard]] ToleranceTask task() const {
    ToleranceTask out{&grid, from, kind, 0.5, 0.2 / 3, &may_walk, 4.2};
    out.stagger_share = 0.25 / 3;
    return out;
  }
};

TEST(Tolerance, AQuarterTurnIsMadeTheOtherWayRound) {
  // Diagonally across the floor: one behind the other halfway, 0.707 m apart, 0.24 m of which a late one takes.
  Floor floor;
  floor.walk({2, 2}, {5, 4});
  floor.walk({2, 3}, {6, 4});
  floor.may_walk = [](Point a, Point b) { return distance(a, b) <= 4.5; };
  const Tolerance done = keep_apart_when_late(floor.task(), floor.to, floor.target_of);
  EXPECT_TRUE(done.left.empty());
  EXPECT_EQ(done.exchanges, 1);
  EXPECT_EQ(done.waits, 0);
  EXPECT_EQ(floor.target_of, (std::vector<std::uint32_t>{1, 0}));
}

TEST(Tolerance, WhoMayNotExchangeLeavesLaterOrArrivesEarlier) {
  Floor floor;
  floor.walk({2, 2}, {5, 4});
  floor.walk({2, 3}, {6, 4});
  floor.kind = {0, 1};
  const Tolerance done = keep_apart_when_late(floor.task(), floor.to, floor.target_of);
  EXPECT_TRUE(done.left.empty());
  EXPECT_EQ(done.exchanges, 0);
  EXPECT_EQ(done.waits, 1);
  EXPECT_TRUE(done.walks[0].start > 0 || done.walks[0].end < 1) << "the other needs nearly all of the time";
}

TEST(Tolerance, ATargetMovesOnlyWhereTheDrawingMayGiveWay) {
  Floor floor;
  floor.walk({2, 2}, {5, 4});
  floor.walk({2, 3}, {6, 4});
  floor.kind = {0, 1};
  ToleranceTask task = floor.task();
  task.stagger_share = 0;
  const auto to = floor.to;
  EXPECT_EQ(keep_apart_when_late(task, floor.to, floor.target_of).left.size(), 1U);
  EXPECT_EQ(floor.to, to);
  const std::vector<char> free(static_cast<std::size_t>(floor.grid.size()), 1);
  task.free = free;
  const Tolerance done = keep_apart_when_late(task, floor.to, floor.target_of);
  EXPECT_TRUE(done.left.empty());
  EXPECT_EQ(done.moved, 1);
}

TEST(Tolerance, TwoOfTwoKindsWhoseWaysCrossWalkOneAfterTheOther) {
  Floor floor;
  floor.walk({2, 4}, {4, 2});
  floor.walk({4, 4}, {2, 2});
  floor.kind = {0, 1};
  ToleranceTask task = floor.task();
  task.late_share = 0.1 / 3;
  const Tolerance done = keep_apart_when_late(task, floor.to, floor.target_of);
  EXPECT_TRUE(done.left.empty());
  EXPECT_EQ(done.waits, 2) << "one is there early, the other leaves late: neither has time enough alone";
}

TEST(Tolerance, KeepsWhoAndWhereAndTheLimitsAndSaysTheTruthAboutWhatIsLeft) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    Floor floor;
    const std::size_t people = 2 + rng.below(90);
    floor.from = tests::random_cells(floor.grid, people, rng);
    floor.to = floor.from;
    // Everybody to a free cell nearby, where there is one.
    std::vector<char> taken(static_cast<std::size_t>(floor.grid.size()), 0);
    for (const CellIndex cell : floor.from) taken[cell.at()] = 1;
    for (CellIndex& cell : floor.to) {
      const auto near = floor.grid.within(floor.grid.centre(cell), 4.2);
      const CellIndex wish = near[rng.below(near.size())];
      if (taken[wish.at()] != 0) continue;
      taken[cell.at()] = 0;
      taken[wish.at()] = 1;
      cell = wish;
    }
    floor.target_of.resize(people);
    std::iota(floor.target_of.begin(), floor.target_of.end(), 0U);
    const std::uint64_t kinds = 1 + rng.below(4);
    for (std::size_t i = 0; i < people; ++i) floor.kind.push_back(static_cast<std::uint32_t>(rng.below(kinds)));
    ToleranceTask task = floor.task();
    const std::vector<char> free(static_cast<std::size_t>(floor.grid.size()), 1);
    if (rng.below(2) == 0) task.free = free;
    const auto too_near = [&](const std::vector<TimedWalk>& walks) {
      std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
      for (std::uint32_t a = 0; a < walks.size(); ++a) {
        for (std::uint32_t b = a + 1; b < walks.size(); ++b) {
          if (least_squared_when_late_m2(walks[a], walks[b], task.late_share) < 0.25 - 1e-9) pairs.emplace_back(a, b);
        }
      }
      return pairs;
    };
    std::vector<TimedWalk> before;
    for (std::size_t i = 0; i < people; ++i) {
      before.push_back({{floor.grid.centre(floor.from[i]), floor.grid.centre(floor.to[i])}});
    }
    const Tolerance done = keep_apart_when_late(task, floor.to, floor.target_of);
    RC_ASSERT(done.left == too_near(done.walks));
    if (task.free.empty()) RC_ASSERT(done.moved == 0);
    auto order = floor.target_of;
    std::sort(order.begin(), order.end());
    auto cells = floor.to;
    std::sort(cells.begin(), cells.end());
    RC_ASSERT(std::adjacent_find(cells.begin(), cells.end()) == cells.end());
    for (std::uint32_t i = 0; i < people; ++i) {
      RC_ASSERT(order[i] == i);
      RC_ASSERT(floor.kind[floor.target_of[i]] == floor.kind[i]);
      const TimedWalk& timed = done.walks[i];
      RC_ASSERT(timed.walk.to == floor.grid.centre(floor.to[floor.target_of[i]]));
      RC_ASSERT(distance(timed.walk.from, timed.walk.to) <= 4.2 * (timed.end - timed.start) + 1e-9);
    }
    if (before.empty() || too_near(before).empty()) RC_ASSERT(done.exchanges + done.waits + done.moved == 0);
  }));
}

}  // namespace
}  // namespace footlight::planner
