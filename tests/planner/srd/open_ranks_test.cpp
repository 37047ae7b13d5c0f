// SPDX-License-Identifier: Apache-2.0
#include "planner/srd/open_ranks.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/planner/srd/srd_tasks.hpp"

namespace footlight::planner::srd {
namespace {

using test::add_group;
using test::block;
using test::crossing;
using test::task_on;
using test::TaskFloor;

std::vector<March> marches(const MotionTask& task) {
  const FreeFloor floor(*task.floor);
  auto groups = divide(task, {}, floor);
  EXPECT_TRUE(groups) << groups.error();
  return groups ? groups->march : std::vector<March>{};
}

double widest(const March& march) {
  double most = 0;
  for (const Frame& frame : march.frames()) most = std::max(most, frame.spread);
  return most;
}

TEST(OpenRanks, NearestOthersAreThoseWithinTheLook) {
  EXPECT_EQ(nearest_others({{0, 0}, {0.5, 0}, {0.5, 0.75}, {9, 9}}, 2), (std::vector<double>{0.5, 0.5, 0.75, 2}));
}

TEST(OpenRanks, AreOpenedAsFarAsOthersNeedAndOnlyWhileTheyPass) {
  const TaskFloor floor;
  // Neighbours a metre from each other who need half of that: 2.4 times as much is 1.2 m.
  for (const March& march : marches(crossing(floor, 5, 5, 60))) {
    EXPECT_EQ(march.frames().front().spread, 1);
    EXPECT_EQ(march.frames().back().spread, 1);
    EXPECT_NEAR(widest(march), 1.2, 1e-9);
    EXPECT_NEAR(march.at(march.arrives_s() / 2).spread, 1.2, 1e-9);
    EXPECT_NEAR(march.at(march.arrives_s() / 8).spread, 1, 1e-9);  // 24 m from each other
    // 2.8 m to the corner's place, opened with 15 % of 1.4 m/s.
    for (std::size_t k = 1; k < march.frames().size(); ++k) {
      const double per_s =
          (march.frames()[k].spread - march.frames()[k - 1].spread) / (march.times_s()[k] - march.times_s()[k - 1]);
      EXPECT_LE(std::abs(per_s), 0.15 * 1.4 / std::hypot(2.0, 2.0) + 1e-6);
    }
  }
}

TEST(OpenRanks, StayClosedWhereTheyAreLooseEnough) {
  const TaskFloor floor;
  for (const March& march : marches(crossing(floor, 5, 5, 60, 1.25))) EXPECT_EQ(widest(march), 1);
}

TEST(OpenRanks, StayClosedWhereNobodyIsMet) {
  const TaskFloor floor;
  MotionTask task = task_on(floor, 60);
  add_group(task, 0, block({-20, 5}, 5, 5), block({16, 5}, 5, 5));
  add_group(task, 1, block({16, 25}, 5, 5), block({-20, 25}, 5, 5));
  for (const March& march : marches(task)) EXPECT_EQ(widest(march), 1);
}

TEST(OpenRanks, StayClosedWhereGroupsWalkSideBySide) {
  const TaskFloor floor;
  MotionTask task = task_on(floor, 60);
  add_group(task, 0, block({-20, 5}, 5, 5, 0.5), block({16, 5}, 5, 5, 0.5));
  add_group(task, 1, block({-20, 7.5}, 5, 5, 0.5), block({16, 7.5}, 5, 5, 0.5));
  for (const March& march : marches(task)) EXPECT_EQ(widest(march), 1);
}

TEST(OpenRanks, AreOpenedLessWhereTheFloorEnds) {
  const TaskFloor floor(60, 6);  // 5.5 m for the centres of people
  MotionTask task = task_on(floor, 60);
  add_group(task, 0, block({-20, 0.75}, 6, 6, 0.9), block({15, 0.75}, 6, 6, 0.9));
  add_group(task, 1, block({15, 0.75}, 6, 6, 0.9), block({-20, 0.75}, 6, 6, 0.9));
  const Point low = floor.floor->low();
  const Point high = floor.floor->high();
  for (const March& march : marches(task)) {
    EXPECT_GT(widest(march), 1.01);
    EXPECT_LT(widest(march), 1.2);
    for (const Frame& frame : march.frames()) {
      for (const double y : {-2.25, 2.25}) {
        const Point at = Placing(frame)({{0, y}, {0, y}});
        EXPECT_GE(at.y, low.y - 1e-9);
        EXPECT_LE(at.y, high.y + 1e-9);
      }
    }
  }
}

}  // namespace
}  // namespace footlight::planner::srd
