// SPDX-License-Identifier: Apache-2.0
#include "planner/motion/snap_crowd.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"
#include "planner/repair/closest_approach.hpp"
#include "tests/support/plan_builder.hpp"

namespace footlight::planner {
namespace {

Stage open_stage(int columns, int rows) {
  Stage stage;
  stage.grid = *Grid::make(GridKind::square, columns, rows, 1.0);
  return stage;
}

/// People on a floor who are led somewhere.
struct Led {
  Stage stage;
  std::vector<CellIndex> from;
  std::vector<CellIndex> to;
  std::vector<std::vector<Point>> at;
  std::vector<double> at_s;
  std::vector<double> longest_m;

  [[nodiscard]] SnapCrowdTask task(const Ways& ways) const { return {&ways, {}, from, to, &at, at_s, longest_m}; }
};

/// On straight ways that swing to the side, at a speed that can be followed.
Led random_crowd(Rng& rng, bool blocked) {
  Led led;
  led.stage.grid = *Grid::make(static_cast<GridKind>(rng.below(3)), 20, 16, 1.0);
  if (blocked) {
    for (int i = 0; i < led.stage.grid.size(); ++i) {
      if (rng.below(25) == 0) led.stage.blocked.push_back(CellIndex::of(i));
    }
  }
  const Ways ways(led.stage, 0.25);
  std::vector<CellIndex> standable;
  for (int i = 0; i < led.stage.grid.size(); ++i) {
    if (ways.can_stand(CellIndex::of(i))) standable.push_back(CellIndex::of(i));
  }
  const std::size_t people = 2 + rng.below(40);
  led.from = tests::random_cells(standable, people, rng);
  led.to = tests::random_cells(standable, people, rng);
  const std::size_t instants = 13;
  for (std::size_t k = 0; k < instants; ++k) {
    led.at_s.push_back(2.0 * static_cast<double>(k));
    if (k > 0) led.longest_m.push_back(2.8);
    const double share = static_cast<double>(k) / static_cast<double>(instants - 1);
    auto& here = led.at.emplace_back();
    for (std::size_t p = 0; p < people; ++p) {
      const Point a = led.stage.grid.centre(led.from[p]);
      const Point b = led.stage.grid.centre(led.to[p]);
      here.push_back(a + share * (b - a) + Point{0, 1.5 * std::sin(3.14159 * share)});
    }
  }
  return led;
}

std::set<CellIndex> set_of(const std::vector<CellIndex>& cells) { return {cells.begin(), cells.end()}; }

TEST(SnapCrowd, GivesEverybodyACellOfHerOwnThatCanBeWalkedTo) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    Led led = random_crowd(rng, true);
    const bool free_end = rng.below(2) == 0;
    if (free_end) led.to.clear();
    const Ways ways(led.stage, 0.25);
    const auto snapped = snap_crowd(led.task(ways), {});
    RC_ASSERT(snapped && !snapped->caught);
    RC_ASSERT(snapped->cells.size() == led.at_s.size());
    RC_ASSERT(snapped->cells.front() == led.from);
    if (!free_end) RC_ASSERT(snapped->cells.back() == led.to);
    for (std::size_t k = 0; k < snapped->cells.size(); ++k) {
      RC_ASSERT(set_of(snapped->cells[k]).size() == led.from.size());
      if (k == 0 || (k + 1 == snapped->cells.size() && !free_end)) continue;
      for (std::size_t p = 0; p < led.from.size(); ++p) {
        const Point a = led.stage.grid.centre(snapped->cells[k - 1][p]);
        const Point b = led.stage.grid.centre(snapped->cells[k][p]);
        RC_ASSERT(distance(a, b) <= led.longest_m[k - 1]);
        RC_ASSERT(ways.can_stand(snapped->cells[k][p]));
        RC_ASSERT(a == b || ways.straight(a, b));
      }
    }
  }));
}

TEST(SnapCrowd, IsInTimeForThePlacesAtTheEndOfAnOpenFloor) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    const Led led = random_crowd(rng, false);
    const auto snapped = snap_crowd(led.task(Ways(led.stage, 0.25)), {});
    const auto& before = snapped->cells[snapped->cells.size() - 2];
    for (std::size_t p = 0; p < led.from.size(); ++p) {
      RC_ASSERT(distance(led.stage.grid.centre(before[p]), led.stage.grid.centre(led.to[p])) <= led.longest_m.back());
    }
  }));
}

TEST(SnapCrowd, DoesNotDependOnTheOrderOfPeople) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    const Led led = random_crowd(rng, true);
    const Ways ways(led.stage, 0.25);
    const auto snapped = snap_crowd(led.task(ways), {});
    std::vector<std::size_t> order(led.from.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (std::size_t i = order.size(); i-- > 1;) std::swap(order[i], order[rng.below(i + 1)]);
    Led other = led;
    for (std::size_t p = 0; p < order.size(); ++p) {
      other.from[p] = led.from[order[p]];
      other.to[p] = led.to[order[p]];
      for (std::size_t k = 0; k < led.at.size(); ++k) other.at[k][p] = led.at[k][order[p]];
    }
    const auto renumbered = snap_crowd(other.task(ways), {});
    for (std::size_t k = 0; k < led.at.size(); ++k) {
      for (std::size_t p = 0; p < order.size(); ++p) {
        RC_ASSERT(renumbered->cells[k][p] == snapped->cells[k][order[p]]);
      }
    }
  }));
}

/// One person's instants, two seconds apart.
Led one_led(const Stage& stage, Cell from, std::vector<Point> at, double longest_m) {
  Led led;
  led.stage = stage;
  led.from = {stage.grid.index(from)};
  for (const Point here : at) {
    if (!led.at.empty()) led.longest_m.push_back(longest_m);
    led.at.push_back({here});
    led.at_s.push_back(2.0 * static_cast<double>(led.at_s.size()));
  }
  return led;
}

TEST(SnapCrowd, TakesTheNearestCellAndSaysHowFarThatIs) {
  const Stage stage = open_stage(9, 9);
  const Point home = stage.grid.centre(Cell{4, 4});
  const Led led = one_led(stage, {4, 4}, {home, home + Point{1.1, 0.2}, home + Point{2.3, 0.4}}, 2.8);
  const auto snapped = snap_crowd(led.task(Ways(stage, 0.25)), {});
  EXPECT_EQ(snapped->cells[1][0], stage.grid.index({5, 4}));
  EXPECT_EQ(snapped->cells[2][0], stage.grid.index({6, 4}));
  EXPECT_NEAR(snapped->max_m, 0.5, 1e-12);
  EXPECT_EQ(snapped->farthest_instant, 2U);
  EXPECT_NEAR(snapped->mean_m, (std::hypot(0.1, 0.2) + 0.5) / 2, 1e-12);
}

TEST(SnapCrowd, OfTwoWhoWantOneCellTheSumOfSquaresDecides) {
  const Stage stage = open_stage(9, 9);
  const Point home = stage.grid.centre(Cell{4, 4});
  Led led = one_led(stage, {3, 4}, {home + Point{-1, 0}, home + Point{0.1, 0}}, 2.8);
  led.from.push_back(stage.grid.index({5, 4}));
  led.at[0].push_back(home + Point{1, 0});
  led.at[1].push_back(home + Point{0.3, 0});
  const auto snapped = snap_crowd(led.task(Ways(stage, 0.25)), {});
  EXPECT_EQ(snapped->cells[1][0], stage.grid.index({4, 4}));
  EXPECT_EQ(snapped->cells[1][1], stage.grid.index({5, 4}));
}

TEST(SnapCrowd, PeopleOfTwoKindsWhoMeetHeadOnPassEachOther) {
  const Stage stage = open_stage(9, 9);
  const Point home = stage.grid.centre(Cell{4, 4});
  Led led = one_led(stage, {3, 4}, {home + Point{-1, 0}, home + Point{1, 0}}, 2.8);
  led.from.push_back(stage.grid.index({5, 4}));
  led.at[0].push_back(home + Point{1, 0});
  led.at[1].push_back(home + Point{-1, 0});
  const std::vector<std::uint32_t> kind{0, 1};
  const Ways ways(stage, 0.25);
  SnapCrowdTask task = led.task(ways);
  task.clearance_m = 0.6;
  EXPECT_EQ(snap_crowd(task, {})->cells[1][0], stage.grid.index({5, 4}));  // of one kind they exchange targets
  task.kind = kind;
  const auto snapped = snap_crowd(task, {});
  const std::vector<Walk> walks{{led.at[0][0], stage.grid.centre(snapped->cells[1][0])},
                                {led.at[0][1], stage.grid.centre(snapped->cells[1][1])}};
  EXPECT_GE(closest_approach(walks[0], walks[1]).distance_m, 0.6);
  EXPECT_LT(snapped->max_m, 1.5);
}

TEST(SnapCrowd, WhoIsLedTooFastComesAfterAsFastAsSheWalks) {
  const Stage stage = open_stage(30, 9);
  const Point home = stage.grid.centre(Cell{2, 4});
  std::vector<Point> at;
  for (int k = 0; k < 6; ++k) at.push_back(home + Point{4.0 * k, 0});
  const Led led = one_led(stage, {2, 4}, at, 2.8);
  const auto snapped = snap_crowd(led.task(Ways(stage, 0.25)), {});
  for (int k = 1; k < 6; ++k) EXPECT_EQ(snapped->cells[std::size_t(k)][0], stage.grid.index({2 + 2 * k, 4}));
}

TEST(SnapCrowd, GoesAroundAWallThatAModelHasPassed) {
  Stage stage = open_stage(15, 11);
  for (int row = 0; row < 8; ++row) stage.blocked.push_back(stage.grid.index({7, row}));
  const Ways ways(stage, 0.25);
  const Point there = stage.grid.centre(Cell{12, 3});
  Led led = one_led(stage, {3, 3}, std::vector<Point>(12, there), 2.8);
  led.to = {stage.grid.index({12, 3})};
  const auto snapped = snap_crowd(led.task(ways), {});
  for (std::size_t k = 1; k < snapped->cells.size(); ++k) {
    EXPECT_TRUE(ways.straight(stage.grid.centre(snapped->cells[k - 1][0]), stage.grid.centre(snapped->cells[k][0])));
  }
  EXPECT_EQ(snapped->cells[10][0], led.to[0]);
}

TEST(SnapCrowd, GivesWayToWhatMoves) {
  const Stage stage = open_stage(13, 9);
  const Ways ways(stage, 0.25);
  const Point home = stage.grid.centre(Cell{6, 4});
  const Led led = one_led(stage, {6, 4}, std::vector<Point>(9, home), 2.8);
  std::vector<Ways> leg_ways;
  const auto disc = [&](int k) { return SweptDisc{home + Point{2.0 * k - 8, 0}, home + Point{2.0 * k - 6, 0}, 1.2}; };
  for (int k = 0; k < 8; ++k) leg_ways.push_back(ways.beside({disc(k)}, {disc(k + 1)}));
  SnapCrowdTask task = led.task(ways);
  task.leg_ways = leg_ways;
  const auto snapped = snap_crowd(task, {});
  ASSERT_FALSE(snapped->caught);
  bool gave_way = false;
  for (std::size_t k = 1; k < 9; ++k) {
    const Point a = stage.grid.centre(snapped->cells[k - 1][0]);
    const Point b = stage.grid.centre(snapped->cells[k][0]);
    EXPECT_TRUE(leg_ways[k - 1].straight(a, b)) << k;
    gave_way = gave_way || distance(b, home) > 1;
  }
  EXPECT_TRUE(gave_way);
  EXPECT_EQ(snapped->cells.back()[0], led.from[0]);
}

TEST(SnapCrowd, NamesWhomSomethingReachesThatIsTooFast) {
  const Stage stage = open_stage(13, 3);
  const Ways ways(stage, 0.25);
  const Point home = stage.grid.centre(Cell{6, 1});
  const Led led = one_led(stage, {6, 1}, std::vector<Point>(3, home), 1.2);
  // It fills the floor's whole depth.
  std::vector<Ways> leg_ways{ways.beside({}, {{home + Point{-3, 0}, home, 2.0}}),
                             ways.beside({{home + Point{-3, 0}, home, 2.0}}, {})};
  SnapCrowdTask task = led.task(ways);
  task.leg_ways = leg_ways;
  const auto snapped = snap_crowd(task, {});
  ASSERT_TRUE(snapped->caught);
  EXPECT_EQ(snapped->caught->instant, 1U);
  EXPECT_EQ(snapped->caught->at, home);
}

TEST(SnapCrowd, StopsWhenTold) {
  const Stage stage = open_stage(9, 9);
  const Led led = one_led(stage, {4, 4}, std::vector<Point>(3, stage.grid.centre(Cell{4, 4})), 2.8);
  const std::atomic<bool> stop = true;
  EXPECT_FALSE(snap_crowd(led.task(Ways(stage, 0.25)), {{}, &stop}));
}

TEST(FollowedShare, IsTheInscribedCircleOfTheCellsInReach) {
  const Grid grid = *Grid::make(GridKind::square, 9, 9, 1.0);
  EXPECT_EQ(followed_share(grid, 0.9), 0);
  EXPECT_NEAR(followed_share(grid, 1.0), std::sqrt(0.5), 1e-9);  // a diamond of four cells
  EXPECT_NEAR(followed_share(grid, 1.5), 1 / 1.5, 1e-9);         // a square of eight
  EXPECT_NEAR(followed_share(grid, std::sqrt(5.0)), 2 / std::sqrt(5.0), 1e-9);
  const Grid hexagons = *Grid::make(GridKind::hexagonal, 9, 9, 1.0);
  EXPECT_NEAR(followed_share(hexagons, 1.0 + 1e-9), std::sqrt(0.75), 1e-9);
  // Half of the steps over triangles go from cells that point up, half from those that point down: together a hexagon.
  EXPECT_NEAR(followed_share(*Grid::make(GridKind::triangular, 9, 9, 1.0), 1.0 + 1e-9), 0.75, 1e-9);
}

}  // namespace
}  // namespace footlight::planner
