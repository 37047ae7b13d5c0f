// SPDX-License-Identifier: Apache-2.0
#include "app/paper/part.hpp"

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

#include "planner/validate.hpp"
#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

using tests::mark_at;

/// 120 counts a minute: two counts a second.
Show plain_show(std::size_t people) {
  Show show;
  for (std::size_t p = 0; p < people; ++p) show.performers.push_back({std::to_string(p + 1), "", {}, 0, 0, ""});
  return show;
}

Plan plan_with_section(const Grid& grid, std::vector<std::vector<Mark>> tracks, double end_s) {
  Plan plan = tests::plan_of(grid, std::move(tracks));
  plan.sections.push_back({"all", kStart, instant_at(end_s), 100, {}, {}, {}});
  return plan;
}

TEST(Parts, AWaitIsOnePlaceAndAMarkThatIsPassedStraightIsNone) {
  const Grid grid = *Grid::make(GridKind::square, 10, 4, 1);
  Plan plan = plan_with_section(grid,
                                {{mark_at(0, grid, 0, 0), mark_at(2, grid, 0, 0), mark_at(3, grid, 1, 0),
                                  mark_at(4, grid, 2, 0), mark_at(5, grid, 4, 0), mark_at(8, grid, 4, 0)}},
                                8);
  const Part part = parts_of(plan, plain_show(1)).front();
  ASSERT_EQ(part.size(), 3U) << "the wait, where the pace changes, the end";
  EXPECT_EQ(part[0].until, instant_at(2));
  EXPECT_EQ(part[1].cell, grid.index({2, 0}));
  EXPECT_EQ(part[1].from, part[1].until);
  EXPECT_EQ(part[2].from, instant_at(5));
  EXPECT_EQ(part[2].until, instant_at(8));
  ASSERT_TRUE(part[0].way);
  EXPECT_EQ(part[0].way->leave, instant_at(2));
  EXPECT_EQ(part[0].way->steps, 4);
  EXPECT_DOUBLE_EQ(part[0].way->length_m, 2);
  EXPECT_FALSE(part[2].way);
  // A formation stands where she passes: people talk about it.
  plan.formations.push_back({"all/2", SectionIndex(0), 7, instant_at(3), {}, {grid.index({1, 0})}, 1});
  EXPECT_EQ(parts_of(plan, plain_show(1)).front().size(), 4U);
}

TEST(Parts, TheLeftFootLeavesOnOddCountsAndLongStepsAreHalved) {
  const Grid grid = *Grid::make(GridKind::square, 20, 4, 1);
  const Plan plan = plan_with_section(
      grid, {{mark_at(0, grid, 0, 0), mark_at(1.5, grid, 2, 0), mark_at(3.5, grid, 5, 1), mark_at(4.5, grid, 8, 1)}},
      4.5);
  const Part part = parts_of(plan, plain_show(1)).front();
  ASSERT_EQ(part.size(), 4U);
  EXPECT_EQ(part[0].way->steps, 3) << "three counts";
  EXPECT_TRUE(part[0].way->left_foot) << "on count 1";
  EXPECT_FALSE(part[1].way->left_foot) << "on count 4";
  EXPECT_EQ(part[1].way->steps, 4);
  EXPECT_EQ(part[2].way->steps, 4) << "1.5 m on a count are two steps of 0.75 m";
  EXPECT_TRUE(part[2].way->left_foot);
}

TEST(Parts, NeighboursAreThoseNearestOnEachSideAsOneFacesTheAudience) {
  const Grid grid = *Grid::make(GridKind::square, 9, 9, 1);
  const auto stays = [&](int column, int row) {
    return std::vector<Mark>{mark_at(0, grid, column, row), mark_at(1, grid, column, row)};
  };
  const Plan plan = plan_with_section(
      grid, {stays(4, 4), stays(6, 4), stays(7, 4), stays(3, 4), stays(4, 2), stays(4, 5), stays(8, 8)}, 1);
  const std::vector<Part> parts = parts_of(plan, plain_show(7));
  const Place& place = parts[0].front();
  EXPECT_EQ(place.left, PerformerIndex(1)) << "+x is stage left";
  EXPECT_EQ(place.right, PerformerIndex(3));
  EXPECT_EQ(place.ahead, PerformerIndex(4)) << "downstage";
  EXPECT_FALSE(parts[6].front().left);
  EXPECT_FALSE(parts[6].front().ahead);
}

TEST(Parts, TheClosestOfAllEncountersIsWhatTheJudgeFinds) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    Rng rng(seed);
    const Grid grid = *Grid::make(GridKind::square, 16, 12, 1);
    const Plan plan = tests::random_plan(grid, 40, 6, true, rng);
    const std::vector<Part> parts = parts_of(plan, plain_show(40));
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t p = 0; p < parts.size(); ++p) {
      for (const Place& place : parts[p]) {
        if (!place.way || !place.way->closest) continue;
        const Encounter& met = *place.way->closest;
        least = std::min(least, met.distance_m);
        EXPECT_GE(met.at, place.way->leave);
        EXPECT_LE(met.at, place.way->arrive);
        const double there =
            distance(position_at(grid, plan.tracks[p], met.at), position_at(grid, plan.tracks[met.who.at()], met.at));
        EXPECT_NEAR(there, met.distance_m, 1e-6);
      }
    }
    const auto judged = planner::closest_approach(plan, kStart, instant_at(10));
    EXPECT_NEAR(least, judged.distance_m, 1e-9);
  }
}

}  // namespace
}  // namespace footlight::app
