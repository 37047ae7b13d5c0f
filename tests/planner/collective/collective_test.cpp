// SPDX-License-Identifier: Apache-2.0
#include "planner/collective/collective.hpp"

#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "core/terrain.hpp"
#include "planner/collective/social_crowd.hpp"
#include "planner/motion/models.hpp"
#include "tests/planner/collective/task_builder.hpp"

namespace footlight::planner {
namespace {

using collective::TimedWays;
using tests::block_of;
using tests::FloorTask;
using tests::task_on;

Grid floor_of(int columns, int rows) { return *Grid::make(GridKind::square, columns, rows, 1); }

/// Of everybody at the end from her place.
double farthest_off(const MotionTask& task, const Trajectory& led) {
  double most = 0;
  for (std::size_t p = 0; p < task.people(); ++p) {
    most = std::max(most, distance(led.at.back()[p], task.to[led.place_of[p]]));
  }
  return most;
}

FloorTask square_to_line(double duration_s = 30) {
  const Grid grid = floor_of(40, 20);
  return task_on(40, 20, {}, block_of(grid, {2, 5}, 5, 5), block_of(grid, {12, 10}, 25, 1), duration_s);
}

TEST(Collective, LeadsEverybodyToAPlaceOfHerOwn) {
  const FloorTask floor = square_to_line();
  const auto led = move_crowd(floor.task, CollectiveOptions{}, {});
  ASSERT_TRUE(led) << led.error();
  EXPECT_EQ(led->at.front(), floor.task.from);
  EXPECT_EQ(led->at.size(), floor.task.at_s.size());
  EXPECT_EQ(std::set(led->place_of.begin(), led->place_of.end()).size(), floor.task.people());
  EXPECT_LT(farthest_off(floor.task, *led), 0.3);
}

TEST(Collective, NobodyIsFasterThanShe) {
  FloorTask floor = square_to_line(10);
  floor.task.speed_mps[7] = 0.9;
  const auto led = move_crowd(floor.task, CollectiveOptions{}, {});
  ASSERT_TRUE(led) << led.error();
  for (std::size_t k = 1; k < led->at.size(); ++k) {
    for (std::size_t p = 0; p < floor.task.people(); ++p) {
      const double span_s = floor.task.at_s[k] - floor.task.at_s[k - 1];
      EXPECT_LE(distance(led->at[k][p], led->at[k - 1][p]), floor.task.speed_mps[p] * span_s + 1e-9) << p;
    }
  }
}

TEST(Collective, PlacesOfAGroupAreForItsPeople) {
  const Grid grid = floor_of(30, 10);
  FloorTask floor = task_on(30, 10, {}, block_of(grid, {2, 2}, 4, 1), block_of(grid, {20, 2}, 4, 1), 20);
  floor.task.group = {0, 1, 0, 1};
  floor.task.to_group = {1, 1, 0, 0};
  const auto led = move_crowd(floor.task, CollectiveOptions{}, {});
  ASSERT_TRUE(led) << led.error();
  for (std::size_t p = 0; p < 4; ++p) EXPECT_EQ(floor.task.to_group[led->place_of[p]], floor.task.group[p]);
}

TEST(Collective, AGroupWithoutPlacesForAllIsAnError) {
  const Grid grid = floor_of(30, 10);
  FloorTask floor = task_on(30, 10, {}, block_of(grid, {2, 2}, 3, 1), block_of(grid, {20, 2}, 3, 1), 20);
  floor.task.group = {0, 1, 0};
  floor.task.to_group = {1, 1, 0};
  const auto led = move_crowd(floor.task, CollectiveOptions{}, {});
  ASSERT_FALSE(led);
  EXPECT_EQ(led.error(), input_error("a group of 2 people has 1 places in the formation (as many as people)"));
}

std::vector<Cell> wall(int column, int rows) {
  std::vector<Cell> out;
  for (int row = 0; row < rows; ++row) out.push_back({column, row});
  return out;
}

TEST(Collective, AnUnreachablePlaceIsAnErrorThatSaysWhere) {
  const Grid grid = floor_of(21, 10);
  const FloorTask floor = task_on(21, 10, wall(10, 10), {grid.centre(Cell{2, 2}), grid.centre(Cell{2, 5})},
                                  {grid.centre(Cell{15, 2}), grid.centre(Cell{3, 5})}, 20);
  const auto led = move_crowd(floor.task, CollectiveOptions{}, {});
  ASSERT_FALSE(led);
  EXPECT_EQ(led.error(),
            input_error("unreachable target: nobody can get to the place at [5 m, 2.5 m], blocked cells are "
                        "all around (open a way, or move the place)"));
}

TEST(Collective, NobodyEverEntersAnObstacle) {
  const Grid grid = floor_of(30, 16);
  const FloorTask floor =
      task_on(30, 16, wall(14, 12), block_of(grid, {2, 2}, 6, 6), block_of(grid, {20, 2}, 6, 6), 60);
  const auto led = move_crowd(floor.task, CollectiveOptions{}, {});
  ASSERT_TRUE(led) << led.error();
  const double keep_m = floor.ways->keep_m();
  for (const auto& at : led->at) {
    for (const Point p : at) {
      const auto near = floor.floor->nearest(p, keep_m);
      EXPECT_TRUE(!near || near->distance_m >= keep_m - 1e-3) << p.x << " " << p.y;
    }
  }
  EXPECT_LT(farthest_off(floor.task, *led), 0.5) << "and all get there";
}

TEST(Collective, PeopleMakeWayForAMovingObstacle) {
  const Grid grid = floor_of(30, 16);
  const MovingObstacle car{1.5, {{1, {-10, 8}}, {21, {10, 8}}}, {}};
  const FloorTask floor = task_on(30, 16, {}, block_of(grid, {12, 5}, 5, 5), block_of(grid, {14, 5}, 5, 5), 20, {car});
  const auto led = move_crowd(floor.task, CollectiveOptions{}, {});
  ASSERT_TRUE(led) << led.error();
  for (std::size_t k = 0; k < led->at.size(); ++k) {
    const auto disc = floor.floor->discs(floor.task.at_s[k]).front();
    for (const Point p : led->at[k])
      EXPECT_GE(distance(p, disc.centre), disc.radius_m + 0.25 - 1e-6) << floor.task.at_s[k];
  }
}

TEST(TimedWays, BringTheMiddleThroughTheGroupsPath) {
  const Grid grid = floor_of(60, 30);
  FloorTask floor = task_on(60, 30, {}, block_of(grid, {5, 5}, 4, 4), block_of(grid, {51, 5}, 4, 4), 60);
  floor.task.paths = {{std::nullopt, {{0, 20}}, {}}};
  const auto ways = TimedWays::make(floor.task, floor.task.to, nullptr, 58);
  ASSERT_TRUE(ways) << ways.error();
  Point middle;
  for (std::size_t p = 0; p < 16; ++p) middle = middle + 1.0 / 16 * ways->place(p, 29);
  EXPECT_NEAR(middle.x, 0, 1e-9) << "half of the way in half of the time: the path is as long on both sides";
  EXPECT_NEAR(middle.y, 20, 1e-9);
  EXPECT_NEAR(distance(ways->place(0, 29), ways->place(1, 29)), 1, 1e-9) << "the formation keeps its shape";
}

TEST(TimedWays, ChangeTheFormationEvenlyAlongAStraightPath) {
  // From a row of 1 m to one of 3 m, through the middle of the way: 2 m there.
  FloorTask floor = task_on(60, 30, {}, {{-20, 10}, {-19, 10}}, {{19, 10}, {22, 10}}, 60);
  floor.task.paths = {{std::nullopt, {{0.5, 10}}, {}}};
  const auto ways = TimedWays::make(floor.task, floor.task.to, nullptr, 58);
  ASSERT_TRUE(ways) << ways.error();
  EXPECT_NEAR(distance(ways->place(0, 29), ways->place(1, 29)), 2, 1e-9);
}

TEST(TimedWays, TimeTheCornersOfAWayAroundByTheirLength) {
  const Grid grid = floor_of(21, 10);
  const FloorTask floor = task_on(21, 10, wall(10, 8), {grid.centre(Cell{8, 0})}, {grid.centre(Cell{12, 0})}, 22);
  const collective::WalkField field(*floor.ways);
  const auto ways = TimedWays::make(floor.task, floor.task.to, &field, 20);
  ASSERT_TRUE(ways) << ways.error();
  const auto way = ways->of(0);
  ASSERT_GE(way.size(), 3U);
  EXPECT_DOUBLE_EQ(way.front().end_s, 20);
  for (std::size_t k = 1; k < way.size(); ++k) {
    const double speed = distance(way[k].at, way[k - 1].at) / (way[k].at_s - way[k - 1].at_s);
    EXPECT_NEAR(speed, way.front().left_m / 20, 1e-9) << "one speed all the way";
  }
}

/// Two blocks of files two metres apart that change sides.
FloorTask crossing(int rows_apart = 0) {
  const Grid grid = floor_of(60, 24);
  std::vector<Point> from = block_of(grid, {2, 4}, 6, 6, 2);
  std::vector<Point> right = block_of(grid, {46, 4 + rows_apart}, 6, 6, 2);
  from.insert(from.end(), right.begin(), right.end());
  std::vector<Point> to = block_of(grid, {46, 4}, 6, 6, 2);
  std::vector<Point> left = block_of(grid, {2, 4 + rows_apart}, 6, 6, 2);
  to.insert(to.end(), left.begin(), left.end());
  FloorTask floor = task_on(60, 24, {}, from, to, 50);
  for (std::size_t p = 0; p < 72; ++p) floor.task.group[p] = p < 36 ? 0 : 1;
  floor.task.to_group = floor.task.group;
  return floor;
}

/// Mean distance of people from where the best rigid shift of their group's formation has them, worst of the instants.
double torn(const MotionTask& task, const Trajectory& led, std::size_t first, std::size_t last) {
  double worst = 0;
  for (const auto& at : led.at) {
    Point shift;
    for (std::size_t p = first; p < last; ++p) shift = shift + (at[p] - task.from[p]);
    shift = 1 / static_cast<double>(last - first) * shift;
    double sum = 0;
    for (std::size_t p = first; p < last; ++p) sum += distance(at[p] - task.from[p], shift);
    worst = std::max(worst, sum / static_cast<double>(last - first));
  }
  return worst;
}

TEST(WidestShift, PutsFilesBetweenFiles) {
  EXPECT_NEAR(std::abs(collective::widest_shift(std::vector<double>{0, 2, 4}, std::vector<double>{0, 2, 4}, 2)), 1,
              1e-9);
  EXPECT_EQ(collective::widest_shift(std::vector<double>{0, 2, 4}, std::vector<double>{1, 3, 5}, 2), 0)
      << "they are between each other already";
}

TEST(Crossing, GroupsPassBetweenEachOtherAndKeepTheirShape) {
  const FloorTask floor = crossing();
  CollectiveOptions options;
  options.fluctuation_mps2 = 0;
  const auto prepared = collective::prepare(floor.task, options, {});
  ASSERT_TRUE(prepared) << prepared.error();
  ASSERT_EQ(prepared->crossings.size(), 1U);
  EXPECT_LT(prepared->crossings[0].before_m, 0.2) << "they would walk into each other";
  EXPECT_GT(prepared->crossings[0].after_m, 0.7);
  EXPECT_NEAR(length(prepared->crossings[0].aside), 0.5, 0.05);
  EXPECT_EQ(prepared->subgroups, 2U);
  const auto kept = move_crowd(floor.task, options, {});
  options.rigidity = 0;
  const auto paper = move_crowd(floor.task, options, {});
  ASSERT_TRUE(kept && paper);
  const double with = torn(floor.task, *kept, 0, 36);
  const double without = torn(floor.task, *paper, 0, 36);
  EXPECT_LT(with, 0.25);
  EXPECT_LT(with, 0.5 * without) << "the paper's own is torn apart";
}

TEST(Collective, IsTheSameForAnyNumberOfThreads) {
  const FloorTask floor = crossing(1);
  std::vector<Trajectory> found;
  for (const std::size_t threads : {1U, 2U, 8U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    auto led = move_crowd(floor.task, CollectiveOptions{}, {});
    ASSERT_TRUE(led) << led.error();
    found.push_back(std::move(*led));
  }
  EXPECT_EQ(found[0].at, found[1].at);
  EXPECT_EQ(found[0].at, found[2].at);
}

TEST(Collective, StopsWhenItIsToldTo) {
  const FloorTask floor = square_to_line();
  const std::atomic<bool> stop = true;
  Progress progress;
  progress.stop = &stop;
  const auto led = move_crowd(floor.task, CollectiveOptions{}, progress);
  ASSERT_FALSE(led);
  EXPECT_EQ(led.error().kind, ErrorKind::interrupted);
}

TEST(SocialCrowd, SomebodyAloneWalksAsEquation8SaysFromStepToStep) {
  const FloorTask floor = task_on(30, 10, {}, {{-10, 5}}, {{0, 5}}, 21);
  CollectiveOptions options;
  options.fluctuation_mps2 = 0;
  options.feedback = false;
  const auto ways = TimedWays::make(floor.task, floor.task.to, nullptr, 20);
  ASSERT_TRUE(ways);
  const collective::SocialCrowd crowd(floor.task, options, *ways, {});
  const auto now = crowd.begin();
  auto next = now;
  ++next.tick;
  crowd.step(now, next);
  // Wanted 10 m in 20 s; (0.5 - 0) / 0.5 m/s^2 for 0.1 s.
  EXPECT_NEAR(next.velocity[0].x, 0.1, 1e-12);
  EXPECT_NEAR(next.position[0].x, -9.99, 1e-12);
  EXPECT_EQ(next.velocity[0].y, 0);
}

TEST(SocialCrowd, TwoWhoMeetPushEachOtherAlike) {
  FloorTask floor = task_on(30, 10, {}, {{-0.3, 5}, {0.3, 5}}, {{-0.3, 5}, {0.3, 5}}, 20);
  CollectiveOptions options;
  options.fluctuation_mps2 = 0;
  options.feedback = false;
  options.subgroups = false;
  const auto ways = TimedWays::make(floor.task, floor.task.to, nullptr, 18);
  ASSERT_TRUE(ways);
  const collective::SocialCrowd crowd(floor.task, options, *ways, {});
  const auto now = crowd.begin();
  auto next = now;
  crowd.step(now, next);
  // 0.6 m apart, touching at 0.5 m: 2 exp(-0.1 / 0.3) m/s^2 for 0.1 s.
  const double expected = 0.2 * std::exp(-0.1 / 0.3);
  EXPECT_NEAR(next.velocity[0].x, -expected, 1e-12);
  EXPECT_NEAR(next.velocity[1].x, expected, 1e-12);
}

TEST(SocialCrowd, AWideOneAndANarrowOnePushEachOtherByTheRoomBetweenThem) {
  FloorTask floor = task_on(30, 10, {}, {{-0.4, 5}, {0.4, 5}}, {{-0.4, 5}, {0.4, 5}}, 20);
  floor.task.radius_m = {0.45, 0.25};
  CollectiveOptions options;
  options.fluctuation_mps2 = 0;
  options.feedback = false;
  const auto ways = TimedWays::make(floor.task, floor.task.to, nullptr, 18);
  ASSERT_TRUE(ways);
  const collective::SocialCrowd crowd(floor.task, options, *ways, {});
  const auto now = crowd.begin();
  auto next = now;
  crowd.step(now, next);
  // 0.8 m apart, touching at 0.7 m: 2 exp(-0.1 / 0.3) m/s^2 for 0.1 s, as two of 0.25 m do at 0.6 m.
  const double expected = 0.2 * std::exp(-0.1 / 0.3);
  EXPECT_NEAR(next.velocity[0].x, -expected, 1e-12);
  EXPECT_NEAR(next.velocity[1].x, expected, 1e-12);
}

TEST(SocialCrowd, WhoCannotArriveInTimeWalksAsFastAsSheCanOnTheGroundThereIs) {
  FloorTask floor = task_on(60, 10, {}, {{-20, 3}, {-20, 7}}, {{20, 3}, {20, 7}}, 21);
  floor.task.speed_mps = {1.4, 0.9};
  Terrain slow;
  slow.slowest = 0.4;
  slow.width = slow.height = 1;
  slow.grey = {255};  // everywhere
  const MotionFloor hills(*floor.ways, {}, TempoMap(60), kStart, &slow);
  CollectiveOptions options;
  options.fluctuation_mps2 = 0;
  options.feedback = false;
  for (const bool level : {true, false}) {
    if (!level) floor.task.floor = &hills;
    const auto ways = TimedWays::make(floor.task, floor.task.to, nullptr, 20);
    ASSERT_TRUE(ways);
    const collective::SocialCrowd crowd(floor.task, options, *ways, {});
    auto now = crowd.begin();
    for (int k = 0; k < 60; ++k) {
      auto next = now;
      ++next.tick;
      crowd.step(now, next);
      now = next;
    }
    // 40 m in 20 s are more than either can: her own limit, and 0.4 of it on the hills.
    EXPECT_NEAR(now.velocity[0].x, level ? 1.4 : 0.56, 1e-4);
    EXPECT_NEAR(now.velocity[1].x, level ? 0.9 : 0.36, 1e-4);
  }
}

TEST(Collective, SlowPeopleAreNotOverrunAndEverybodyArrives) {
  const Grid grid = floor_of(60, 16);
  // Twelve files become six: ways cross, and the slow are among the quick.
  FloorTask floor = task_on(60, 16, {}, block_of(grid, {2, 4}, 12, 3, 2), block_of(grid, {46, 2}, 6, 6, 2), 66);
  for (std::size_t p = 0; p < 36; p += 3) {
    floor.task.speed_mps[p] = 0.8;
    floor.task.radius_m[p] = 0.4;
  }
  const auto led = move_crowd(floor.task, CollectiveOptions{}, {});
  ASSERT_TRUE(led) << led.error();
  EXPECT_LT(farthest_off(floor.task, *led), 0.3);
  for (std::size_t k = 0; k < led->at.size(); ++k) {
    for (std::size_t a = 0; a < 36; ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        const double touch_m = floor.task.radius_m[a] + floor.task.radius_m[b];
        ASSERT_GT(distance(led->at[k][a], led->at[k][b]), 0.95 * touch_m) << a << " and " << b << " at " << k;
      }
    }
  }
}

TEST(SocialCrowd, WhoIsPressedAgainstAWallSlidesAlongIt) {
  const FloorTask floor = task_on(21, 16, wall(10, 10), {{-6, 12}}, {{6, 5}}, 30);
  CollectiveOptions options;
  options.fluctuation_mps2 = 0;
  options.repulsion_mps2 = 0;  // as where her sub-group draws her on as much as the wall pushes
  const collective::WalkField field(*floor.ways);
  const auto ways = TimedWays::make(floor.task, floor.task.to, &field, 28);
  ASSERT_TRUE(ways) << ways.error();
  const collective::SocialCrowd crowd(floor.task, options, *ways, {});
  auto now = crowd.begin();
  now.position[0] = {-0.5 - floor.ways->keep_m(), 9};  // touches it, and her first corner is around its end at y = 10
  for (int k = 0; k < 250; ++k) {
    auto next = now;
    ++next.tick;
    crowd.step(now, next);
    ASSERT_LE(distance(next.position[0], now.position[0]), 1.4 * 0.1 + 1e-9);
    ASSERT_GE(floor.floor->nearest(next.position[0], 5).value_or(MotionFloor::Nearest{{}, 5}).distance_m,
              floor.ways->keep_m() - 1e-6);
    now = next;
  }
  EXPECT_GT(now.position[0].x, 1) << "she is behind it";
}

TEST(SocialCrowd, FeedbackBringsHeadingsTogether) {
  // Left of the middle people want to the left, right of it to the right, and one wants upstage: the places tell the
  // direction, and those around her draw her along.
  std::vector<Point> from, to;
  for (int i = 0; i < 10; ++i) {
    from.push_back({-12.4 + 0.5 * i, 5});
    to.push_back(from.back() + (i == 5 ? Point{0, 4} : Point{-2, 0}));
    from.push_back({7.6 + 0.5 * i, 5});
    to.push_back(from.back() + Point{2, 0});
  }
  const FloorTask floor = task_on(40, 10, {}, from, to, 20);
  CollectiveOptions options;
  options.fluctuation_mps2 = 0;
  options.subgroups = false;
  options.repulsion_mps2 = 0;
  options.bin_m = 10;
  const auto ways = TimedWays::make(floor.task, to, nullptr, 18);
  ASSERT_TRUE(ways);
  const auto drift_of_the_odd_one = [&](bool feedback) {
    options.feedback = feedback;
    const collective::SocialCrowd crowd(floor.task, options, *ways, {});
    auto now = crowd.begin();
    for (int k = 0; k < 20; ++k) {
      auto next = now;
      ++next.tick;
      crowd.step(now, next);
      now = next;
    }
    if (feedback) {
      EXPECT_GT(now.information.direction_bits, 0.2);
    }
    return now.velocity[10].x;
  };
  EXPECT_EQ(drift_of_the_odd_one(false), 0);
  EXPECT_LT(drift_of_the_odd_one(true), -0.05);
}

}  // namespace
}  // namespace footlight::planner
