// SPDX-License-Identifier: Apache-2.0
#include "planner/srd/groups.hpp"

#include <numeric>
#include <set>

#include <gtest/gtest.h>

#include "tests/planner/srd/srd_tasks.hpp"

namespace footlight::planner::srd {
namespace {

using test::add_group;
using test::block;
using test::task_on;
using test::TaskFloor;

Result<Groups> divided(const MotionTask& task, const SrdOptions& options = {}) {
  const FreeFloor floor(*task.floor);
  return divide(task, options, floor);
}

TEST(SrdGroups, GroupMovesFromItsMiddleOverItsPathToTheMiddleOfItsPlaces) {
  const TaskFloor floor;
  MotionTask task = task_on(floor, 60);
  add_group(task, 3, block({-20, 5}, 3, 3), block({20, 5}, 3, 3));
  task.paths.push_back({GroupIndex(3), {{-10, 20}, {10, 20}}, {}});
  const auto groups = divided(task);
  ASSERT_TRUE(groups) << groups.error();
  EXPECT_EQ(groups->march.front().corners(), (std::vector<Point>{{-19, 6}, {-10, 20}, {10, 20}, {21, 6}}));
}

TEST(SrdGroups, WhoHasNoPathOfItsOwnTakesTheOneOfNobodyOrGoesStraight) {
  const TaskFloor floor;
  MotionTask task = task_on(floor, 60);
  add_group(task, 0, block({-20, 5}, 2, 2), block({20, 5}, 2, 2));
  add_group(task, 1, block({-20, 25}, 2, 2), block({20, 25}, 2, 2));
  EXPECT_EQ(divided(task)->march[1].corners().size(), 2U);
  task.paths.push_back({std::nullopt, {{0, 20}}, {}});
  const auto groups = divided(task);
  ASSERT_TRUE(groups) << groups.error();
  EXPECT_EQ(groups->march[0].corners()[1], (Point{0, 20}));
  EXPECT_EQ(groups->march[1].corners()[1], (Point{0, 20}));
}

TEST(SrdGroups, KeptFormationIsNotMixed) {
  const TaskFloor floor;
  MotionTask task = task_on(floor, 60);
  const auto from = block({-20, 5}, 5, 4);
  auto to = block({10, 20}, 5, 4);
  std::rotate(to.begin(), to.begin() + 7, to.end());  // places are in any order
  add_group(task, 0, from, to);
  const auto groups = divided(task);
  ASSERT_TRUE(groups) << groups.error();
  for (std::size_t i = 0; i < from.size(); ++i) {
    EXPECT_EQ(task.to[groups->place_of[i]], from[i] + (Point{30, 15}));
    EXPECT_NEAR(distance(groups->offsets[i].from, groups->offsets[i].to), 0, 1e-9);
  }
}

TEST(SrdGroups, WheelingFormationIsLaidOnItsGoalAsItArrives) {
  const TaskFloor floor;
  MotionTask task = task_on(floor, 120);
  // A line across the way to stage left arrives upstage as a line across that.
  add_group(task, 0, block({-20, 5}, 1, 5), block({18, 35}, 5, 1));
  task.paths.push_back({std::nullopt, {{20, 7}, {20, 35}}, {}});
  SrdOptions options;
  options.orientation = SrdOptions::Orientation::wheel;
  const auto groups = divided(task, options);
  ASSERT_TRUE(groups) << groups.error();
  for (std::size_t i = 0; i < 5; ++i) {
    // The downstage one is on the right of the way, and stays there.
    EXPECT_EQ(task.to[groups->place_of[i]], (Point{22 - double(i), 35}));
  }
}

TEST(SrdGroups, PlacesOfNobodyAreSharedByWholeCrowdAlongTheirPaths) {
  const TaskFloor floor;
  MotionTask task = task_on(floor, 60);
  add_group(task, 0, block({-20, 10}, 2, 2), block({-20, 20}, 2, 2));
  add_group(task, 1, block({10, 10}, 2, 2), block({10, 20}, 2, 2));
  task.to_group.clear();
  task.paths.push_back({GroupIndex(0), {{10, 20}}, {}});
  task.paths.push_back({GroupIndex(1), {{-20, 20}}, {}});
  const auto groups = divided(task);
  ASSERT_TRUE(groups) << groups.error();
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(task.to[groups->place_of[i]].x > 0, i < 4) << i;
  EXPECT_EQ(std::set<std::uint32_t>(groups->place_of.begin(), groups->place_of.end()).size(), 8U);
}

TEST(SrdGroups, WithoutPlacesTheFormationIsCarriedToTheEndOfItsPath) {
  const TaskFloor floor;
  MotionTask task = task_on(floor, 60);
  add_group(task, 0, block({-20, 5}, 2, 2), {});
  task.paths.push_back({std::nullopt, {{10, 5.5}}, {}});
  const auto groups = divided(task);
  ASSERT_TRUE(groups) << groups.error();
  EXPECT_TRUE(groups->place_of.empty());
  EXPECT_EQ(groups->march.front().corners().back(), (Point{10, 5.5}));
  EXPECT_NEAR(distance(groups->offsets[0].to, {-0.5, -0.5}), 0, 1e-9);
}

TEST(SrdGroups, WayGoesAroundWhatIsBlocked) {
  std::vector<Cell> wall;
  for (int row = 0; row < 30; ++row) wall.push_back({30, row});
  const TaskFloor floor(60, 40, wall);
  MotionTask task = task_on(floor, 100);
  add_group(task, 0, block({-20.5, 5.5}, 2, 2), block({20.5, 5.5}, 2, 2));
  const auto groups = divided(task);
  ASSERT_TRUE(groups) << groups.error();
  const auto& corners = groups->march.front().corners();
  ASSERT_GT(corners.size(), 2U);
  for (std::size_t i = 1; i < corners.size(); ++i) EXPECT_TRUE(floor.ways->straight(corners[i - 1], corners[i]));
}

TEST(SrdGroups, SayWhatCannotBe) {
  std::vector<Cell> walls;
  for (int row = 0; row < 40; ++row) walls.push_back({30, row});
  const TaskFloor parted(60, 40, walls);
  MotionTask task = task_on(parted, 100);
  add_group(task, 0, block({-20.5, 5.5}, 2, 2), block({20.5, 5.5}, 2, 2));
  EXPECT_EQ(divided(task).error(),
            input_error("there is no way around the blocked cells from (-20.0 m, 6.0 m) to (21.0 m, 6.0 m)"));

  std::vector<Cell> ring;
  for (int i = 0; i < 5; ++i) {
    for (const Cell cell : {Cell{40 + i, 10}, Cell{40 + i, 14}, Cell{40, 10 + i}, Cell{44, 10 + i}})
      ring.push_back(cell);
  }
  std::sort(ring.begin(), ring.end());
  ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
  const TaskFloor cage(60, 40, ring);
  task = task_on(cage, 100);
  add_group(task, 0, {{-20.5, 12.5}, {-10.5, 12.5}}, {{2.5, 12.5}, {12.5, 12.5}});
  EXPECT_EQ(divided(task).error(), input_error("nobody can walk from (-10.5 m, 12.5 m) to (12.5 m, 12.5 m): blocked "
                                               "cells are all around one of them"));

  const TaskFloor open;
  task = task_on(open, 100);
  add_group(task, 0, block({-20, 5}, 2, 2), block({20, 5}, 2, 1));
  add_group(task, 1, block({-20, 15}, 2, 1), block({20, 15}, 2, 2));
  EXPECT_EQ(divided(task).error(), input_error("a group of 4 people has 2 places"));
  task.to_group.assign(6, 1);
  EXPECT_EQ(divided(task).error(), input_error("a group of 4 people has 0 places"));
  task.to_group.assign(6, 2);
  EXPECT_EQ(divided(task).error(), input_error("nobody is in the group whose place (20.0 m, 5.0 m) is"));
}

}  // namespace
}  // namespace footlight::planner::srd
