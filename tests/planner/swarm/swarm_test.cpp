// SPDX-License-Identifier: Apache-2.0
// Steps of both swarms, one by one.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <tbb/task_arena.h>

#include "core/rng.hpp"
#include "planner/motion/models.hpp"
#include "planner/repair/closest_approach.hpp"
#include "planner/swarm/collisions.hpp"
#include "planner/swarm/original.hpp"
#include "planner/swarm/proposed.hpp"
#include "tests/planner/swarm/scene.hpp"

namespace footlight::planner::swarm {
namespace {

using test::Scene;

/// A floor with a few blocked rectangles, a few people and as many places, all of it by chance; with hills on some.
Scene any_scene(std::uint64_t seed) {
  Rng rng(seed);
  std::vector<std::string> blocked;
  for (std::uint64_t n = rng.below(4); n > 0; --n) {
    const auto column = static_cast<int>(3 + rng.below(16));
    const auto row = static_cast<int>(rng.below(12));
    blocked.push_back(cell_name({column, row}) + ":" +
                      cell_name({column + static_cast<int>(rng.below(4)), row + static_cast<int>(rng.below(4))}));
  }
  Scene scene(24, 16, blocked);
  const auto anywhere = [&] {
    std::vector<CellIndex> cells;
    for (int cell = 0; cell < scene.stage().grid.size(); ++cell) {
      if (scene.ways().can_stand(CellIndex::of(cell))) cells.push_back(CellIndex::of(cell));
    }
    for (std::size_t i = cells.size(); i-- > 1;) std::swap(cells[i], cells[rng.below(i + 1)]);
    return cells;
  };
  const auto from = anywhere();
  const auto to = anywhere();
  const std::size_t people = 1 + rng.below(30);
  for (std::size_t p = 0; p < people; ++p) {
    const std::string a = scene.stage().grid.name(from[p]);
    const std::string b = scene.stage().grid.name(to[p]);
    scene.send(a + ":" + a, b + ":" + b);
  }
  for (double& speed_mps : scene.task().speed_mps) speed_mps = 0.5 + rng.uniform();
  if (rng.below(2) == 1) {
    Terrain hills;
    hills.slowest = 0.3;
    hills.width = 3;
    hills.height = 2;
    for (int n = 0; n < 6; ++n) hills.grey.push_back(static_cast<std::uint8_t>(rng.below(256)));
    scene.terrain(hills);
  }
  scene.task().seed = rng.next();
  return scene;
}

template <class Model, class Check>
void step_through(const Model& model, int steps, Check check) {
  typename Model::State now = model.begin();
  for (int n = 0; n < steps; ++n) {
    typename Model::State next = now;
    ++next.tick;
    model.step(now, next);
    check(now, next);
    now = std::move(next);
  }
}

void expect_lawful(Scene& scene, const Crowd& now, const Crowd& next, double step_s) {
  const MotionTask& task = scene.task();
  for (std::size_t p = 0; p < now.position.size(); ++p) {
    RC_ASSERT(scene.ways().straight(now.position[p], next.position[p]));
    const double limit_mps = task.speed_mps[p] * scene.floor().speed_factor(now.position[p]);
    RC_ASSERT(distance(now.position[p], next.position[p]) <= limit_mps * step_s + 1e-9);
  }
}

TEST(Swarm, NobodyEverEntersAnObstacleOrIsFasterThanTheLimit) {
  EXPECT_TRUE(rc::check([] {
    Scene scene = any_scene(*rc::gen::arbitrary<std::uint64_t>());
    const auto landscape = Landscape::make(scene.task(), {});
    if (!landscape) return;  // a place is walled in
    const OriginalSwarm original(*landscape);
    const ProposedSwarm proposed(*landscape);
    step_through(original, 60, [&](const auto& now, const auto& next) { expect_lawful(scene, now, next, 0.2); });
    step_through(proposed, 60, [&](const auto& now, const auto& next) { expect_lawful(scene, now, next, 0.2); });
  }));
}

TEST(Swarm, NobodyTouchesAnybodyInTheProposedOne) {
  EXPECT_TRUE(rc::check([] {
    Scene scene = any_scene(*rc::gen::arbitrary<std::uint64_t>());
    const auto landscape = Landscape::make(scene.task(), {});
    if (!landscape) return;
    step_through(ProposedSwarm(*landscape), 60, [&](const auto& now, const auto& next) {
      std::vector<Walk> walks;
      for (std::size_t p = 0; p < now.position.size(); ++p) walks.push_back({now.position[p], next.position[p]});
      RC_ASSERT(near_pairs(walks, 0.5 - 1e-6).empty());
    });
  }));
}

TEST(Swarm, NobodyTouchesAnybodyHoweverWideOrQuickTheyAre) {
  EXPECT_TRUE(rc::check([] {
    const auto seed = *rc::gen::arbitrary<std::uint64_t>();
    Scene scene = any_scene(seed);
    Rng rng(seed);
    MotionTask& task = scene.task();
    for (double& radius_m : task.radius_m) radius_m = 0.2 + 0.25 * rng.uniform();
    const auto landscape = Landscape::make(task, {});
    if (!landscape) return;
    step_through(ProposedSwarm(*landscape), 60, [&](const auto& now, const auto& next) {
      std::vector<Walk> walks;
      for (std::size_t p = 0; p < now.position.size(); ++p) walks.push_back({now.position[p], next.position[p]});
      for (const NearPair& pair : near_pairs(walks, 0.9)) {
        RC_ASSERT(pair.approach.distance_m >= task.radius_m[pair.a] + task.radius_m[pair.b] - 1e-6);
      }
    });
  }));
}

TEST(Swarm, SlowPeopleAreNotOverrunAndEverybodyArrives) {
  Scene scene(44, 14);
  for (int n = 0; n < 30; ++n) {  // every second cell: between two of their places the widest can pass
    const std::string from = cell_name({2 * (n % 5), 2 * (n / 5)});
    const std::string to = cell_name({34 + 2 * (n % 5), 2 * (n / 5)});
    scene.send(from + ":" + from, to + ":" + to);
  }
  MotionTask& task = scene.task();
  for (std::size_t p = 0; p < task.people(); p += 3) {
    task.speed_mps[p] = 0.8;
    task.radius_m[p] = 0.4;
  }
  task.at_s = {0, 100};
  const auto led = move_crowd(task, SwarmOptions{}, {});
  ASSERT_TRUE(led) << led.error();
  EXPECT_EQ(led->notes.back(), "the swarm has 0 collisions between people and 0 with obstacles on its way")
      << "with the room of each, and nobody is late";
}

TEST(Swarm, PlacesStayAPermutationWhenTheyAreExchanged) {
  Scene scene(24, 16);
  scene.send("A1:E10", "P3:T12");
  const auto landscape = Landscape::make(scene.task(), {});
  ASSERT_TRUE(landscape);
  bool exchanged = false;
  step_through(ProposedSwarm(*landscape), 150, [&](const auto& now, const auto& next) {
    std::vector<std::uint32_t> places = next.place;
    std::sort(places.begin(), places.end());
    for (std::uint32_t n = 0; n < places.size(); ++n) ASSERT_EQ(places[n], n);
    exchanged = exchanged || now.place != next.place;
  });
  EXPECT_TRUE(exchanged);
}

TEST(Swarm, AHigherKKeepsPeopleFartherApart) {
  double least_m[] = {1e9, 1e9};
  for (int n = 0; n < 2; ++n) {
    Scene scene(30, 9);
    for (const char* row : {"3", "5", "7"}) {
      scene.send(std::string("A") + row + ":C" + row, std::string("AA") + row + ":AC" + row, 0);
      scene.send(std::string("AA") + row + ":AC" + row, std::string("A") + row + ":C" + row, 1);
    }
    SwarmOptions options;
    options.hardness = n == 0 ? 1 : 3;
    const auto landscape = Landscape::make(scene.task(), options);
    ASSERT_TRUE(landscape);
    step_through(ProposedSwarm(*landscape), 200, [&](const auto&, const auto& next) {
      for (std::size_t a = 0; a < next.position.size(); ++a) {
        for (std::size_t b = 0; b < a; ++b) {
          least_m[n] = std::min(least_m[n], distance(next.position[a], next.position[b]));
        }
      }
    });
  }
  EXPECT_GE(least_m[0], 0.5 - 1e-9);
  EXPECT_LT(least_m[0], 0.8);
  // Each looks at where the others were: two who step toward each other come nearer than sqrt(3) x 0.5 m by one step.
  EXPECT_GT(least_m[1], std::sqrt(3.0) * 0.5 - 2 * 1.4 * 0.2);
  EXPECT_GT(least_m[1], least_m[0]);
}

TEST(Swarm, TheOriginalOneFliesThroughPeople) {
  Scene scene(30, 5);
  scene.send("A3:D3", "AA3:AD3", 0).send("AA3:AD3", "A3:D3", 1);
  const auto landscape = Landscape::make(scene.task(), {});
  ASSERT_TRUE(landscape);
  Collisions original(scene.task());
  step_through(OriginalSwarm(*landscape), 300,
               [&](const auto& now, const auto& next) { original.step(now.position, next.wanted, 0, 0.2); });
  EXPECT_GT(original.between_people(), 3U);
}

TEST(SwarmCollisions, AreCountedSweptAndOnceWhileTheyLast) {
  Scene scene(20, 10, {"J5:J5"});  // its outline from (-1, 4) to (0, 5)
  scene.send("A1:B1", "A1:B1");
  Collisions counted(scene.task());
  // Through each other between two steps, at whose ends they are far apart.
  counted.step(std::vector<Point>{{-5, 1}, {-3, 1}}, std::vector<Point>{{-3, 1}, {-5, 1.1}}, 0, 1);
  EXPECT_EQ(counted.between_people(), 1U);
  counted.step(std::vector<Point>{{-3, 1}, {-5, 1.1}}, std::vector<Point>{{-3, 1}, {-5, 1.1}}, 1, 2);
  counted.step(std::vector<Point>{{-3, 1}, {-2.6, 1}}, std::vector<Point>{{-3, 1}, {-2.6, 1}}, 2, 3);
  counted.step(std::vector<Point>{{-3, 1}, {-2.6, 1}}, std::vector<Point>{{-3, 1}, {-2.7, 1}}, 3, 4);
  EXPECT_EQ(counted.between_people(), 2U) << "standing too close for two steps is one collision";
  EXPECT_EQ(counted.with_obstacles(), 0U);
  counted.step(std::vector<Point>{{-3, 4.5}, {5, 1}}, std::vector<Point>{{3, 4.5}, {5, 1}}, 4, 5);
  EXPECT_EQ(counted.with_obstacles(), 1U);
}

TEST(SwarmCollisions, WithWhatMovesAreSweptInItsFrame) {
  Scene scene(20, 10);
  scene.send("K5:K5", "K5:K5");                            // at (0.5, 4.5)
  scene.moving({1, {{1, {-8, 4.5}}, {3, {8, 4.5}}}, {}});  // 16 m in a second
  Collisions counted(scene.task());
  const std::vector<Point> stands{{0.5, 4.5}};
  const std::vector<Point> aside{{0.5, 6.5}};
  counted.step(aside, aside, 0, 1);
  EXPECT_EQ(counted.with_obstacles(), 0U);
  counted.step(stands, stands, 0, 1);
  EXPECT_EQ(counted.with_obstacles(), 1U);
}

TEST(Swarm, PeopleStepOutOfTheWayOfWhatMoves) {
  Scene scene(30, 15);
  scene.send("J5:L10", "J5:L10");
  scene.moving({1.5, {{5, {-13, 7.5}}, {69, {13, 7.5}}}, {}});  // 0.8 m/s right through them
  const auto landscape = Landscape::make(scene.task(), {});
  ASSERT_TRUE(landscape);
  Collisions counted(scene.task());
  double from_s = 0;
  step_through(ProposedSwarm(*landscape), 220, [&](const auto& now, const auto& next) {
    counted.step(now.position, next.position, from_s, from_s + 0.2);
    from_s += 0.2;
  });
  EXPECT_EQ(counted.with_obstacles(), 0U);
  EXPECT_EQ(counted.between_people(), 0U);
}

template <class Model>
std::vector<Point> after_steps(const Landscape& landscape, int threads) {
  tbb::task_arena arena(threads);
  std::vector<Point> out;
  arena.execute(
      [&] { step_through(Model(landscape), 12, [&](const auto&, const auto& next) { out = next.position; }); });
  return out;
}

TEST(Swarm, GivesTheSameBytesForAnyNumberOfThreads) {
  Scene scene(60, 40, {"AC15:AG25"});
  scene.send("A1:T32", "AN1:BG32");
  const auto landscape = Landscape::make(scene.task(), {});
  ASSERT_TRUE(landscape);
  const auto one = after_steps<ProposedSwarm>(*landscape, 1);
  EXPECT_EQ(one, after_steps<ProposedSwarm>(*landscape, 2));
  EXPECT_EQ(one, after_steps<ProposedSwarm>(*landscape, 8));
  EXPECT_EQ(after_steps<OriginalSwarm>(*landscape, 1), after_steps<OriginalSwarm>(*landscape, 8));
}

}  // namespace
}  // namespace footlight::planner::swarm
