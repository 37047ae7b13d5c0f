// SPDX-License-Identifier: Apache-2.0
#include "planner/motion/floor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"

namespace footlight::planner {
namespace {

constexpr double kKeep_m = 0.3;

Stage open_stage(int columns, int rows) {
  Stage stage;
  stage.grid = *Grid::make(GridKind::square, columns, rows, 1.0);
  return stage;
}

Stage random_stage(Rng& rng) {
  Stage stage;
  stage.grid = *Grid::make(static_cast<GridKind>(rng.below(3)), 14, 12, 1.0);
  for (int i = 0; i < stage.grid.size(); ++i) {
    if (rng.below(12) == 0) stage.blocked.push_back(CellIndex::of(i));
  }
  return stage;
}

double cross(Point a, Point b) { return a.x * b.y - a.y * b.x; }

bool inside(Point p, const std::vector<Point>& outline) {
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Point a = outline[i];
    if (cross(outline[(i + 1) % outline.size()] - a, p - a) < 0) return false;
  }
  return true;
}

/// Distance to the nearest of many points on every blocked outline: no farther than the truth by half their spacing.
double sampled_distance(const Stage& stage, Point p) {
  double least = std::numeric_limits<double>::infinity();
  for (const CellIndex cell : stage.blocked) {
    const auto outline = stage.grid.outline(cell);
    if (inside(p, outline)) return 0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      for (int n = 0; n <= 60; ++n) {
        const Point on = outline[i] + n / 60.0 * (outline[(i + 1) % outline.size()] - outline[i]);
        least = std::min(least, distance(p, on));
      }
    }
  }
  return least;
}

Point random_point(const MotionFloor& floor, Rng& rng) {
  return {floor.low().x + rng.uniform() * (floor.high().x - floor.low().x),
          floor.low().y + rng.uniform() * (floor.high().y - floor.low().y)};
}

TEST(MotionFloor, KnowsTheNearestBlockedPoint) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    const Stage stage = random_stage(rng);
    const Ways ways(stage, kKeep_m);
    const MotionFloor floor(ways, {}, TempoMap(120), kStart);
    for (int n = 0; n < 2; ++n) {
      const Point at = random_point(floor, rng);
      const double radius_m = 3 * rng.uniform();
      const auto near = floor.nearest(at, radius_m);
      const double truth = sampled_distance(stage, at);
      if (truth > radius_m + 1e-9) RC_ASSERT(!near || near->distance_m > truth - 0.01);
      if (truth <= radius_m - 0.01) {
        RC_ASSERT(near);
        RC_ASSERT(std::abs(near->distance_m - truth) < 0.01);
        RC_ASSERT(std::abs(distance(near->at, at) - near->distance_m) < 1e-9);
      }
    }
  }));
}

TEST(MotionFloor, LetsNobodyThroughAnything) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    const Stage stage = random_stage(rng);
    const Ways ways(stage, kKeep_m);
    const MotionFloor floor(ways, {}, TempoMap(120), kStart);
    for (int n = 0; n < 2; ++n) {
      const Point from = random_point(floor, rng);
      const Point to = from + Point{8 * (rng.uniform() - 0.5), 8 * (rng.uniform() - 0.5)};
      const double share = floor.free_share(from, to);
      RC_ASSERT(share >= 0 && share <= 1);
      const double before = sampled_distance(stage, from);
      for (int k = 0; k <= 15; ++k) {
        const Point here = from + k / 15.0 * share * (to - from);
        // Never nearer than allowed, but for who was nearer already and only gets away.
        RC_ASSERT(sampled_distance(stage, here) > std::min(kKeep_m, before) - 0.01);
        RC_ASSERT(here.x > floor.low().x - 1e-9 && here.x < floor.high().x + 1e-9);
        RC_ASSERT(here.y > floor.low().y - 1e-9 && here.y < floor.high().y + 1e-9);
      }
      if (share == 1) continue;
      // A little farther there is something.
      const Point beyond = from + std::min(1.0, share + 0.02 / distance(from, to)) * (to - from);
      const bool off = beyond.x < floor.low().x + 0.03 || beyond.x > floor.high().x - 0.03 ||
                       beyond.y < floor.low().y + 0.03 || beyond.y > floor.high().y - 0.03;
      RC_ASSERT(off || sampled_distance(stage, beyond) < kKeep_m + 0.05);
    }
  }));
}

TEST(MotionFloor, AgreesWithTheWaysOfTheSchedule) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    const Stage stage = random_stage(rng);
    const Ways ways(stage, kKeep_m);
    const MotionFloor floor(ways, {}, TempoMap(120), kStart);
    for (int n = 0; n < 10; ++n) {
      const Point from = stage.grid.centre(CellIndex::of(rng.below(std::uint64_t(stage.grid.size()))));
      const Point to = stage.grid.centre(CellIndex::of(rng.below(std::uint64_t(stage.grid.size()))));
      if (!ways.straight(from, from)) continue;
      const double share = floor.free_share(from, to);
      // What the floor lets through can be walked.
      RC_ASSERT(ways.straight(from, from + share * (1 - 1e-6) * (to - from)) || share < 1e-3);
    }
  }));
}

TEST(MotionFloor, MovesItsDiscsStraightAndEvenlyBetweenCounts) {
  const Stage stage = open_stage(10, 10);
  const Ways ways(stage, kKeep_m);
  // 120 counts a minute: count 5 is at 2 s, the section begins at 1 s.
  const MovingObstacle car{1.5, {{5, {-4, 2}}, {9, {4, 2}}, {13, {4, 8}}}, {}};
  const MotionFloor floor(ways, {car}, TempoMap(120), instant_at(1));
  const auto at = [&](double time_s) { return floor.discs(time_s).front(); };
  EXPECT_EQ(at(0).centre, (Point{-4, 2}));
  EXPECT_EQ(at(0).velocity, (Point{0, 0}));
  EXPECT_NEAR(at(1.5).centre.x, -2, 1e-12);
  EXPECT_NEAR(at(1.5).velocity.x, 4, 1e-12);
  EXPECT_NEAR(at(4).centre.y, 5, 1e-12);
  EXPECT_EQ(at(9).centre, (Point{4, 8}));
  EXPECT_EQ(at(9).radius_m, 1.5);
}

}  // namespace
}  // namespace footlight::planner
