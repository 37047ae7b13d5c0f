// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"
#include "planner/motion/models.hpp"
#include "tests/planner/swarm/scene.hpp"

namespace footlight::planner {
namespace {

using test::Scene;

Trajectory move(Scene& scene, const SwarmOptions& options = {}) {
  auto out = move_crowd(scene.task(), options, {});
  EXPECT_TRUE(out) << out.error().message;
  return out ? *out : Trajectory{};
}

double farthest_m(Scene& scene, const Trajectory& trajectory) {
  double out = 0;
  for (std::size_t p = 0; p < trajectory.place_of.size(); ++p) {
    out = std::max(out, distance(trajectory.at.back()[p], scene.task().to[trajectory.place_of[p]]));
  }
  return out;
}

TEST(MoveSwarm, AStreamArrivesWithoutACollision) {
  Scene scene(40, 16);
  scene.send("B5:E9", "AJ5:AM9");
  const Trajectory out = move(scene);
  EXPECT_EQ(out.at.size(), scene.task().at_s.size());
  EXPECT_EQ(out.at.front(), scene.task().from);
  EXPECT_LT(farthest_m(scene, out), 0.05);
  EXPECT_EQ(out.notes.back(), "the swarm has 0 collisions between people and 0 with obstacles on its way");
}

TEST(MoveSwarm, ACrowdGoesAroundAWideWall) {
  Scene scene(40, 20, {"T3:U18"});
  scene.send("B8:E12", "AJ8:AM12");
  const Trajectory out = move(scene);
  EXPECT_LT(farthest_m(scene, out), 0.05);
}

TEST(MoveSwarm, FourCrowdsExchangeTheirCornersAroundFourObstacles) {
  Scene scene(30, 30, {"I9:K10", "T8:U11", "J20:J22", "S20:V21"});
  scene.send("B2:F3", "Y28:AC29", 0).send("Y2:AC3", "B28:F29", 1);
  scene.send("B28:F29", "Y2:AC3", 2).send("Y28:AC29", "B2:F3", 3);
  const Trajectory out = move(scene);
  EXPECT_LT(farthest_m(scene, out), 0.1) << out.notes.back();
  for (std::size_t p = 0; p < 40; ++p) EXPECT_EQ(scene.task().to_group[out.place_of[p]], p / 10);
}

TEST(MoveSwarm, ACrowdFollowsItsTarget) {
  Scene scene(40, 30);
  scene.send("B2:E5", "AI2:AL5");
  std::vector<Point> wave;
  for (int n = 0; n <= 12; ++n) wave.push_back({-15 + 2.5 * n, 14 + 4 * std::sin(0.5 * n)});
  scene.path(wave);
  const Trajectory out = move(scene);
  EXPECT_LT(farthest_m(scene, out), 0.5);
  // Half-way along the target everybody is near it.
  const auto& half = out.at[60];
  const Point middle = 1.0 / 16 * std::accumulate(half.begin(), half.end(), Point{});
  EXPECT_GT(middle.y, 9) << "the straight way from block to block is at y = 3.5";
}

TEST(MoveSwarm, WithoutPlacesTheFormationGoesAlongItsPath) {
  Scene scene(40, 20);
  scene.send("B2:E3", "B2:E3").path({{-16, 3}, {5, 12}});
  scene.task().to.clear();
  scene.task().to_group.clear();
  const Trajectory out = move(scene);
  EXPECT_TRUE(out.place_of.empty());
  const Point middle = 1.0 / 8 * std::accumulate(out.at.back().begin(), out.at.back().end(), Point{});
  EXPECT_LT(distance(middle, {5, 12}), 0.1);
}

TEST(MoveSwarm, HillsSlowPeopleDown) {
  Terrain flat;
  flat.width = flat.height = 1;
  flat.slowest = 0.4;
  flat.grey = {0};
  Terrain high = flat;
  high.grey = {255};
  const auto half_way = [](const Terrain& terrain) {
    Scene scene(60, 9);
    scene.send("B5:B5", "BE5:BE5").terrain(terrain);
    return move(scene).at[40].front().x - scene.task().from.front().x;  // after 20 s
  };
  EXPECT_GT(half_way(flat), 20 * 1.4 * 0.75);
  EXPECT_LT(half_way(high), 20 * 1.4 * 0.4);
}

TEST(MoveSwarm, TheOrderOfPeopleAndPlacesHasNoInfluence) {
  EXPECT_TRUE(rc::check([](std::uint64_t seed) {
    Scene scene(24, 14, {"L5:M9"});
    scene.send("H4:J8", "P4:R8", 0).send("P9:R11", "H9:J11", 1);
    scene.task().at_s.resize(12);
    scene.task().seed = seed;
    SwarmOptions options;
    if (seed % 2 == 1) options.method = SwarmOptions::Method::original;
    const auto first = move_crowd(scene.task(), options, {});
    MotionTask mixed = scene.task();
    std::vector<std::size_t> who(mixed.from.size());
    std::iota(who.begin(), who.end(), 0U);
    Rng rng(seed);
    for (std::size_t i = who.size(); i-- > 1;) std::swap(who[i], who[rng.below(i + 1)]);
    for (std::size_t i = 0; i < who.size(); ++i) {
      mixed.from[i] = scene.task().from[who[i]];
      mixed.group[i] = scene.task().group[who[i]];
      mixed.to[i] = scene.task().to[who[i]];
      mixed.to_group[i] = scene.task().to_group[who[i]];
    }
    const auto second = move_crowd(mixed, options, {});
    RC_ASSERT(first && second);
    for (std::size_t t = 0; t < first->at.size(); ++t) {
      for (std::size_t i = 0; i < who.size(); ++i) RC_ASSERT(second->at[t][i] == first->at[t][who[i]]);
    }
    for (std::size_t i = 0; i < who.size(); ++i) {
      RC_ASSERT(mixed.to[second->place_of[i]] == scene.task().to[first->place_of[who[i]]]);
    }
  }));
}

TEST(MoveSwarm, TheOriginalOneConvergesAndCountsItsCollisions) {
  Scene scene(40, 20);
  scene.send("B5:E9", "AJ5:AM9");
  SwarmOptions options;
  options.method = SwarmOptions::Method::original;
  const Trajectory out = move(scene, options);
  double mean_m = 0;
  for (std::size_t p = 0; p < 20; ++p) mean_m += distance(out.at.back()[p], scene.task().to[out.place_of[p]]) / 20;
  EXPECT_LT(mean_m, 0.5) << "they began 34 m away";
  EXPECT_NE(out.notes.back().rfind("the original swarm has 0 collisions between people", 0), 0U) << out.notes.back();
}

TEST(MoveSwarm, StopsWhenItIsTold) {
  Scene scene(40, 20);
  scene.send("B5:E9", "AJ5:AM9");
  const std::atomic<bool> stop = true;
  const auto out = move_crowd(scene.task(), SwarmOptions{}, {{}, &stop});
  ASSERT_FALSE(out);
  EXPECT_EQ(out.error().kind, ErrorKind::interrupted);
}

}  // namespace
}  // namespace footlight::planner
