// SPDX-License-Identifier: Apache-2.0
#include "planner/painted/painted_model.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "tests/planner/painted/painted_show.hpp"

namespace footlight::planner {
namespace {

using test::kGrey;
using test::PaintedShow;

/// A painted show that is ready to be moved.
struct Moved {
  explicit Moved(PaintedShow painted, double duration_s = 40, std::vector<MovingObstacle> discs = {})
      : one(std::move(painted)) {
    auto read = one.read();
    EXPECT_TRUE(read) << read.error().message;
    scene = std::make_unique<PaintedScene>(std::move(*read));
    floor = std::make_unique<MotionFloor>(*scene->ways, std::move(discs), one.show.tempo, Instant{});
    for (const CellIndex cell : scene->begin_cells()) task.from.push_back(one.show.stage.grid.centre(cell));
    for (const CellIndex cell : scene->end_cells()) task.to.push_back(one.show.stage.grid.centre(cell));
    const std::size_t people = task.from.size();
    task.group.assign(people, kNoGroup);
    task.radius_m.assign(people, one.show.stage.clearance_m / 2);
    task.speed_mps.assign(people, 1.4);
    for (double t = 0; t <= duration_s; t += 0.5) task.at_s.push_back(t);
    task.floor = floor.get();
    task.painting = scene.get();
  }
  [[nodiscard]] std::vector<std::vector<Point>> run() const {
    const PaintedModel model(task, one.options, *scene);
    return *simulate(model, task.at_s, {});
  }

  PaintedShow one;
  std::unique_ptr<PaintedScene> scene;
  std::unique_ptr<MotionFloor> floor;
  MotionTask task;
};

double farthest_from_goal(const Moved& moved, const std::vector<std::vector<Point>>& way) {
  double most = 0;
  for (std::size_t i = 0; i < way.back().size(); ++i) most = std::max(most, distance(way.back()[i], moved.task.to[i]));
  return most;
}

TEST(PaintedModel, EverybodyComesToHerPlaceInTime) {
  const Moved moved((PaintedShow()));
  const auto way = moved.run();
  EXPECT_LT(farthest_from_goal(moved, way), 0.6);
}

TEST(PaintedModel, NobodyIsFasterThanSheCanWalk) {
  const Moved moved((PaintedShow()));
  const auto way = moved.run();
  for (std::size_t t = 1; t < way.size(); ++t) {
    for (std::size_t i = 0; i < way[t].size(); ++i) EXPECT_LE(distance(way[t][i], way[t - 1][i]), 0.7 + 1e-9);
  }
}

TEST(PaintedModel, PeopleFollowTheStrokeWhereItBends) {
  PaintedShow one;
  one.painter.box(24, 30, 97, 50, {255, 255, 255});
  one.painter.stroke({{24, 40}, {40, 10}, {80, 10}, {96, 40}}, 4, {255, 150, 150}, {110, 20, 20});
  const Moved moved(one, 60);
  const auto way = moved.run();
  double upstage = 0;
  for (const auto& at : way) {
    double mean = 0;
    for (const Point p : at) mean += p.y / 40;
    upstage = std::max(upstage, mean);
  }
  EXPECT_GT(upstage, 14.5);  // the stroke's straight part is at 17.5 m, both shapes are at 10 m
  EXPECT_LT(farthest_from_goal(moved, way), 0.6);

  one.options.stroke_force = 0;
  one.options.flow_force = 0;
  const Moved straight(one, 60);
  double straight_upstage = 0;
  for (const auto& at : straight.run()) {
    double mean = 0;
    for (const Point p : at) mean += p.y / 40;
    straight_upstage = std::max(straight_upstage, mean);
  }
  EXPECT_LT(straight_upstage, 11);
}

TEST(PaintedModel, NobodyEntersTheBackgroundEvenBetweenTwoSteps) {
  PaintedShow one;
  one.painter.box(54, 0, 66, 34, kGrey);
  one.painter.box(54, 48, 66, 80, kGrey);
  const Moved moved(one, 80);
  const auto way = moved.run();
  EXPECT_LT(farthest_from_goal(moved, way), 0.6);
  const double keep = moved.scene->ways->keep_m();
  const PaintedModel model(moved.task, moved.one.options, *moved.scene);
  auto now = model.begin();
  for (int t = 0; t < 800; ++t) {
    auto next = now;
    ++next.tick;
    model.step(now, next);
    for (std::size_t i = 0; i < now.position.size(); ++i) {
      for (int k = 1; k <= 4; ++k) {
        const auto near = moved.floor->nearest(now.position[i] + k / 4.0 * (next.position[i] - now.position[i]), keep);
        ASSERT_FALSE(near && near->distance_m < keep - 1e-4) << i << " at step " << t;
      }
    }
    now = next;
  }
}

TEST(PaintedModel, PeopleKeepApartOnTheWayBetterThanWithoutParticles) {
  const auto pressed = [](double people_force) {
    PaintedShow one;
    one.painter.box(54, 0, 66, 33, kGrey);
    one.painter.box(54, 47, 66, 80, kGrey);
    one.options.people_force = people_force;
    const Moved moved(one, 60);
    double near = 0;
    for (const auto& at : moved.run()) {
      for (std::size_t i = 0; i < at.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) near += distance(at[i], at[k]) < 0.5 ? 1 : 0;
      }
    }
    return near;
  };
  const double with = pressed(1);
  const double without = pressed(0);
  EXPECT_LT(with, 0.6 * without);
}

/// A room with a gate of 3 m on the way; everybody has to go through it.
PaintedShow gate() {
  PaintedShow one;
  one.painter.box(54, 0, 66, 34, kGrey);
  one.painter.box(54, 46, 66, 80, kGrey);
  return one;
}

/// Distance to the nearest other one, of who is still on her way; mean over people and instants.
double room_on_the_way(const Moved& moved, const std::vector<std::vector<Point>>& way) {
  double sum = 0;
  int count = 0;
  for (const auto& at : way) {
    for (std::size_t i = 0; i < at.size(); ++i) {
      if (distance(at[i], moved.task.to[i]) < 3) continue;
      double nearest = 1e9;
      for (std::size_t k = 0; k < at.size(); ++k) {
        if (k != i) nearest = std::min(nearest, distance(at[i], at[k]));
      }
      sum += nearest;
      ++count;
    }
  }
  return sum / count;
}

TEST(PaintedModel, WhoQueuesAtAGateLeavesRoomForCells) {
  const Moved moved(gate(), 80);
  const auto way = moved.run();
  EXPECT_GT(room_on_the_way(moved, way), 0.95);    // cells are a metre apart
  EXPECT_LT(farthest_from_goal(moved, way), 0.6);  // and a wall beside the gate holds nobody
}

TEST(PaintedModel, WidePeopleKeepMoreRoom) {
  Moved moved(gate(), 120);
  const double narrow = room_on_the_way(moved, moved.run());
  moved.task.radius_m.assign(moved.task.people(), 0.7);
  EXPECT_GT(room_on_the_way(moved, moved.run()), 1.1 * narrow);
}

TEST(PaintedModel, WhoIsInFrontDoesNotHoldUpTheOthers) {
  const Moved moved(PaintedShow(), 60);
  const PaintedModel model(moved.task, moved.one.options, *moved.scene);
  auto now = model.begin();
  constexpr double kWalked_s = 5;  // nobody is near her place yet
  for (int t = 0; t < int(kWalked_s / model.step_s()); ++t) {
    auto next = now;
    ++next.tick;
    model.step(now, next);
    now = next;
  }
  const auto front =
      std::max_element(now.position.begin(), now.position.end(), [](Point a, Point b) { return a.x < b.x; });
  const auto n = static_cast<std::size_t>(front - now.position.begin());
  const double own_mps = distance(*front, moved.task.to[n]) / (0.7 * 60 - kWalked_s);
  EXPECT_GT(length(now.velocity[n]), 1.1 * own_mps);
}

TEST(PaintedScene, WhoLeavesFirstOnAWayThatTurnsBackComesFirst) {
  PaintedShow one;
  one.painter.box(0, 0, 120, 80, {255, 255, 255});
  one.painter.box(4, 36, 28, 76, one.options.paint[0].colour);
  one.painter.box(92, 36, 116, 76, one.options.paint[1].colour);
  one.painter.stroke({{16, 34}, {16, 10}, {104, 10}, {104, 34}}, 4, {255, 150, 150}, {110, 20, 20});
  const auto scene = one.read();
  ASSERT_TRUE(scene) << scene.error().message;
  const auto& places = scene->parties[0].places;
  // Up and over: who is upstage in the first shape is downstage in the second, who is on the left stays outside.
  double turned_y = 0;
  double turned_x = 0;
  for (std::size_t i = 0; i < 40; ++i) {
    turned_y += (places[0][i].y - 6) * (places[1][i].y - 6);
    turned_x += (places[0][i].x + 11) * (places[1][i].x - 11);
  }
  EXPECT_LT(turned_y, -100);
  EXPECT_LT(turned_x, -20);
}

TEST(PaintedModel, IsTheSameForAnyNumberOfThreads) {
  PaintedShow one;
  one.show = test::show_with(160, GridKind::square, 30, 20);
  one.show.sections = PaintedShow().show.sections;
  one.painter.box(0, 0, 120, 80, {255, 255, 255});
  one.painter.box(0, 4, 40, 76, one.options.paint[0].colour);
  one.painter.box(80, 4, 120, 76, one.options.paint[1].colour);
  one.painter.stroke({{40, 40}, {80, 40}}, 6, {255, 150, 150}, {110, 20, 20});
  const Moved moved(one, 10);
  std::vector<std::vector<std::vector<Point>>> ways;
  for (const std::size_t threads : {1U, 2U, 8U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    ways.push_back(moved.run());
  }
  EXPECT_EQ(ways[0], ways[1]);
  EXPECT_EQ(ways[0], ways[2]);
}

TEST(PaintedModel, TheOrderOfPeopleHasNoInfluence) {
  Moved moved((PaintedShow()), 20);
  const auto way = moved.run();
  std::reverse(moved.task.from.begin(), moved.task.from.end());
  const auto turned = moved.run();
  for (std::size_t i = 0; i < 40; ++i) {
    EXPECT_NEAR(distance(way.back()[i], turned.back()[39 - i]), 0, 1e-6);
  }
}

TEST(PaintedModel, PeopleStepAsideForSomethingThatMoves) {
  MovingObstacle car;
  car.radius_m = 1;
  car.at = {{1, {0, 2}}, {60, {0, 18}}};
  const Moved moved(PaintedShow(), 40, {car});
  int within = 0;
  std::size_t t = 0;
  for (const auto& at : moved.run()) {
    for (const auto& disc : moved.floor->discs(moved.task.at_s[t])) {
      for (const Point p : at) within += distance(p, disc.centre) < disc.radius_m ? 1 : 0;
    }
    ++t;
  }
  EXPECT_EQ(within, 0);
}

}  // namespace
}  // namespace footlight::planner
