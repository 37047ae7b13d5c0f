// SPDX-License-Identifier: Apache-2.0
#include "planner/srd/march.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/planner/srd/srd_tasks.hpp"

namespace footlight::planner::srd {
namespace {

constexpr double kQuarter = std::numbers::pi / 2;

SrdOptions options_with(SrdOptions::Orientation orientation) {
  SrdOptions options;
  options.orientation = orientation;
  options.corner_m = 1;
  options.settle = 0;
  return options;
}

March::Task corner_task(std::vector<Offsets> offsets, double duration_s) {
  March::Task task{{{0, 0}, {20, 0}, {20, 20}}, std::move(offsets), {}, duration_s};
  task.speed_mps.assign(task.offsets.size(), 1.4);
  return task;
}

/// Fastest place of a march, as share of 1.4 m/s.
double fastest(const March& march, const std::vector<Offsets>& offsets) {
  double most = 0;
  const double step_s = 0.05;
  for (double t = step_s; t < march.arrives_s(); t += step_s) {
    for (const Offsets& one : offsets) {
      const double moved_m = distance(Placing(march.at(t - step_s))(one), Placing(march.at(t))(one));
      most = std::max(most, moved_m / step_s / 1.4);
    }
  }
  return most;
}

TEST(March, CentreWalksEvenlyAlongItsCorners) {
  const auto march = March::plan(corner_task({{}}, 40), options_with(SrdOptions::Orientation::fixed));
  ASSERT_TRUE(march);
  EXPECT_NEAR(march->length_m(), 40, 1e-12);
  EXPECT_NEAR(march->arrives_s(), 40, 1e-6);
  EXPECT_NEAR(distance(march->at(10).centre, {10, 0}), 0, 1e-6);
  EXPECT_NEAR(distance(march->at(30).centre, {20, 10}), 0, 1e-6);
  EXPECT_EQ(march->at(-1).centre, (Point{0, 0}));
  EXPECT_EQ(march->at(1000).centre, (Point{20, 20}));
}

TEST(March, ArrivesEarlierBySettleAndAtTheSpeedThatIsAskedFor) {
  SrdOptions options = options_with(SrdOptions::Orientation::fixed);
  options.settle = 0.25;
  EXPECT_NEAR(March::plan(corner_task({{}}, 80), options)->arrives_s(), 60, 1e-6);
  options.group_speed_mps = 1;
  EXPECT_NEAR(March::plan(corner_task({{}}, 80), options)->arrives_s(), 40, 1e-6);
}

TEST(March, FixedFormationIsCarriedWithoutTurning) {
  const auto march = March::plan(corner_task({{{3, 1}, {3, 1}}}, 80), options_with(SrdOptions::Orientation::fixed));
  ASSERT_TRUE(march);
  for (const double t : {0.0, 13.0, 40.0, 77.0}) {
    const Frame frame = march->at(t);
    EXPECT_NEAR(distance(Placing(frame)({{3, 1}, {3, 1}}), frame.centre + Point{3, 1}), 0, 1e-9);
  }
}

TEST(March, PathTurnsTheFormationAsThePathTurns) {
  const SrdOptions options = options_with(SrdOptions::Orientation::path);
  const std::vector<Point> corners{{0, 0}, {20, 0}, {20, 20}};
  EXPECT_NEAR(March::whole_turn(corners, options), kQuarter, 1e-9);
  // Who walks 2 m ahead and 1 m to the left of the centre does so after the corner, too.
  const Offsets offsets{{2, 1}, {-1, 2}};
  const auto march = March::plan(corner_task({offsets}, 80), options);
  ASSERT_TRUE(march);
  EXPECT_NEAR(distance(Placing(march->at(20))(offsets), march->at(20).centre + Point{2, 1}), 0, 1e-9);
  EXPECT_NEAR(distance(Placing(march->at(60))(offsets), march->at(60).centre + Point{-1, 2}), 0, 1e-9);
  // In the corner the way has turned by half: the formation by an eighth of a circle.
  EXPECT_NEAR(march->at(40).turn_from, kQuarter / 2, 1e-6);
}

TEST(March, WheelTakesTheTimeThatTheOuterOnesNeed) {
  std::vector<Offsets> offsets;
  for (int i = -8; i <= 8; ++i) {
    const Point from{0, double(i)};
    offsets.push_back({from, {-from.y, from.x}});
  }
  const auto path = March::plan(corner_task(offsets, 60), options_with(SrdOptions::Orientation::path));
  const auto wheel = March::plan(corner_task(offsets, 60), options_with(SrdOptions::Orientation::wheel));
  ASSERT_TRUE(path && wheel);
  EXPECT_GT(fastest(*path, offsets), 1.5);
  EXPECT_LE(fastest(*wheel, offsets), 1.02 * kEase);  // between two frames places move on arcs
  EXPECT_NEAR(wheel->arrives_s(), 60, 1e-6);
}

TEST(March, RigidFormationKeepsItsDistancesWhileItWheels) {
  const Offsets a{{0, 5}, {-5, 0}};
  const Offsets b{{1, -3}, {3, 1}};
  const auto wheel = March::plan(corner_task({a, b}, 100), options_with(SrdOptions::Orientation::wheel));
  ASSERT_TRUE(wheel);
  for (double t = 0; t <= 100; t += 0.7) {
    const Placing place(wheel->at(t));
    EXPECT_NEAR(distance(place(a), place(b)), std::hypot(1.0, 8.0), 1e-6);
  }
}

TEST(March, ChangesFormationUnderWay) {
  const Offsets offsets{{-2, 0}, {2, 0}};
  const auto march =
      March::plan({{{0, 0}, {10, 0}}, {offsets}, {1.4}, 20}, options_with(SrdOptions::Orientation::fixed));
  ASSERT_TRUE(march);
  EXPECT_NEAR(distance(Placing(march->at(0))(offsets), {-2, 0}), 0, 1e-9);
  EXPECT_NEAR(distance(Placing(march->at(10))(offsets), {5, 0}), 0, 1e-6);
  EXPECT_NEAR(distance(Placing(march->at(20))(offsets), {12, 0}), 0, 1e-9);
}

TEST(March, AlsoChangesFormationOnTheSpot) {
  const Offsets offsets{{-2, 0}, {2, 0}};
  const auto march = March::plan({{{0, 5}}, {offsets}, {1.4}, 20}, options_with(SrdOptions::Orientation::wheel));
  ASSERT_TRUE(march);
  EXPECT_NEAR(distance(Placing(march->at(10))(offsets), {0, 5}), 0, 1e-9);
}

TEST(March, WaitsForWhoIsOnSlowGround) {
  // A pixel a metre: level until half a metre before the centre line, half of the speed from half a metre behind it on.
  std::vector<std::uint8_t> grey(60, 0);
  std::fill(grey.begin() + 30, grey.end(), 255);
  const test::TaskFloor floor(60, 40, {}, {}, test::ground_of(grey));
  for (const auto orientation : {SrdOptions::Orientation::fixed, SrdOptions::Orientation::path}) {
    SrdOptions options = options_with(orientation);
    options.group_speed_mps = 20;
    March::Task task{{{-10, 20}, {10, 20}}, {{}}, {1.4}, 60};
    // 85 % of 1.4 m/s.
    EXPECT_NEAR(March::plan(task, options)->arrives_s(), 20 / 1.19, 1e-6);
    task.floor = floor.floor.get();
    // 9.5 m level and 9.5 m slow; between them steps of a quarter of a metre, each by the slower of its ends.
    const double between = 1 / 0.875 + 1 / 0.75 + 1 / 0.625 + 1 / 0.5;
    EXPECT_NEAR(March::plan(task, options)->arrives_s(), (9.5 + 9.5 / 0.5 + 0.25 * between) / 1.19, 1e-6);
    // Of two people 4 m from each other the one in front comes to the slow ground 2 m earlier, and the other leaves
    // with her: all of the group is slow then.
    task.offsets = {{{2, 0}, {2, 0}}, {{-2, 0}, {-2, 0}}};
    task.speed_mps = {1.4, 1.4};
    EXPECT_NEAR(March::plan(task, options)->arrives_s(), (7.5 + 11.5 / 0.5 + 0.25 * between) / 1.19, 1e-6);
  }
}

TEST(March, SaysWhenTheGoalCannotBeReachedInTime) {
  const auto march = March::plan(corner_task({{}}, 20), options_with(SrdOptions::Orientation::fixed));
  ASSERT_FALSE(march);
  EXPECT_EQ(march.error(), input_error("a group's way of 40.0 m from (0.0 m, 0.0 m) to (20.0 m, 20.0 m) takes at least "
                                       "33.6 s, and there are 20.0 s"));
}

}  // namespace
}  // namespace footlight::planner::srd
