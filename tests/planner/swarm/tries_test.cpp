// SPDX-License-Identifier: Apache-2.0
#include "planner/swarm/tries.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"
#include "planner/segment.hpp"
#include "planner/swarm/equations.hpp"
#include "tests/planner/swarm/scene.hpp"

namespace footlight::planner::swarm {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

std::vector<Surroundings::Near> people_near(Rng& rng) {
  std::vector<Surroundings::Near> out(rng.below(20));
  for (auto& one : out) {
    one.away = {3 * rng.uniform() - 1.5, 3 * rng.uniform() - 1.5};
    one.per_scope_square = 1 / (0.2 + rng.uniform());
    one.keep_square = 0.25;
  }
  return out;
}

TEST(Tries, AreSweptPastEverybodyNearAtOnceAsOneByOne) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    const auto near = people_near(rng);
    Tries tries;
    for (std::size_t n = 1 + rng.below(lanes::kLanes); n > 0; --n) {
      tries.add(rng.below(5) == 0 ? Point{} : Point{rng.uniform() - 0.5, rng.uniform() - 0.5});
    }
    tries.squared.fill(4);
    tries.room.fill(kFar);
    sweep(near, tries);
    for (std::size_t i = 0; i < tries.size; ++i) {
      double squared = 4;
      double room = kFar;
      for (const auto& one : near) {
        squared = std::min(squared, squared_length(tries.step(i) - one.away) * one.per_scope_square);
        const double swept = squared_length(one.away - nearest_on(one.away, {}, tries.step(i)));
        room = std::min(room, swept - one.keep_square);
      }
      RC_ASSERT(std::abs(tries.squared[i] - squared) < 1e-12);
      RC_ASSERT(room == tries.room[i] || std::abs(tries.room[i] - room) < 1e-12);
    }
  }));
}

TEST(Tries, AreWeighedAsTheEquationsSay) {
  Tries tries;
  tries.add({0.3, -0.4});
  tries.squared[0] = 0.7;
  tries.ground[0] = 0.2;
  weigh({{3.3, 3.6}, 1, 0.05, 0.1, 1.0 / 400}, tries);  // 3 m and 4 m are left, and another metre
  EXPECT_NEAR(tries.worst[0], object_cost(0.7), 1e-15);
  EXPECT_NEAR(tries.weighed[0], 0.05 * object_cost(0.7), 1e-15) << "more than 0.1 x 0.2";
  EXPECT_NEAR(tries.value[0], objective(tries.weighed[0], 6 * 6 / 400.0), 1e-15);
  tries.ground[0] = 0.9;
  weigh({{3.3, 3.6}, 1, 0.05, 0.1, 1.0 / 400}, tries);
  EXPECT_DOUBLE_EQ(tries.worst[0], 0.9);
  EXPECT_DOUBLE_EQ(tries.weighed[0], 0.09);
}

TEST(Tries, AreTurnedByTheirAngles) {
  const std::vector<double> angles{0, std::numbers::pi / 2, -std::numbers::pi / 6};
  Tries tries;
  add_turned({2, 0}, angles, tries);
  ASSERT_EQ(tries.size, 3U);
  EXPECT_EQ(tries.step(0), (Point{2, 0}));
  EXPECT_NEAR(tries.step(1).x, 0, 1e-15);
  EXPECT_NEAR(tries.step(1).y, 2, 1e-15);
  EXPECT_NEAR(tries.step(2).x, std::sqrt(3.0), 1e-15);
  EXPECT_NEAR(tries.step(2).y, -1, 1e-15);
}

TEST(Surroundings, PeopleOfDifferentWidthTouchWhereTheirRadiiSayIt) {
  test::Scene scene(20, 10);
  scene.send("C3:E3", "C5:E5");
  MotionTask& task = scene.task();
  task.radius_m = {0.4, 0.2, 0.3};
  const auto landscape = Landscape::make(task, {});
  ASSERT_TRUE(landscape);
  Surroundings around;
  const std::vector<Point> at{{0, 5}, {0.6, 5}, {0, 5.5}};
  around.sort(*landscape, at, 0, 0.2);
  for (std::size_t rank = 0; rank < 3; ++rank) {
    std::vector<Surroundings::Near> near;
    around.look(rank, near);
    ASSERT_EQ(near.size(), 2U);
    for (const auto& one : near) {
      const double room_m = task.radius_m[around.order()[rank]] + task.radius_m[around.order()[one.rank]];
      EXPECT_NEAR(one.per_scope_square, 1 / (room_m * room_m), 1e-12);
      // Who is nearer already must not come nearer still: 0.5 m where 0.7 m were right.
      EXPECT_NEAR(one.keep_square, std::min(room_m * room_m, squared_length(one.away)), 1e-8);
    }
  }
}

}  // namespace
}  // namespace footlight::planner::swarm
