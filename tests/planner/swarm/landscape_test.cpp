// SPDX-License-Identifier: Apache-2.0
#include "planner/swarm/landscape.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/planner/swarm/scene.hpp"

namespace footlight::planner::swarm {
namespace {

using test::Scene;

std::string error_of(Scene& scene) {
  const auto made = Landscape::make(scene.task(), {});
  return made ? "" : made.error().message;
}

TEST(SwarmLandscape, ATargetStandsStillWithoutAPath) {
  Scene scene(20, 10);
  scene.send("A1:B2", "S1:T2");
  const auto landscape = Landscape::make(scene.task(), {});
  ASSERT_TRUE(landscape);
  EXPECT_EQ(landscape->shifts(0).at(0), (Point{}));
  EXPECT_EQ(landscape->shifts(17).at(0), (Point{}));
}

TEST(SwarmLandscape, ATargetGoesEvenlyAlongItsPathAndComesToRest) {
  Scene scene(40, 20);
  scene.send("A1:A1", "T11:T11");                      // rests at (-0.5, 10.5)
  scene.path({{-0.5, 2.5}, {3.5, 2.5}, {3.5, 10.5}});  // 4 m, 8 m, and 4 m to where it rests
  SwarmOptions options;
  options.follow = 0.8;  // of 60 s: 48 s
  const auto landscape = Landscape::make(scene.task(), options);
  ASSERT_TRUE(landscape);
  const auto at = [&](double s) { return landscape->target(0, landscape->shifts(s).at(0)); };
  EXPECT_NEAR(distance(at(0), {-0.5, 2.5}), 0, 1e-12);
  EXPECT_NEAR(distance(at(12), {3.5, 2.5}), 0, 1e-12) << "a quarter of 16 m";
  EXPECT_NEAR(distance(at(24), {3.5, 6.5}), 0, 1e-12);
  EXPECT_NEAR(distance(at(42), {1.5, 10.5}), 0, 1e-12);
  EXPECT_NEAR(distance(at(48), {-0.5, 10.5}), 0, 1e-12);
  EXPECT_NEAR(distance(at(60), {-0.5, 10.5}), 0, 1e-12);
}

TEST(SwarmLandscape, ATargetThatNobodyCanFollowIsTold) {
  Scene scene(60, 20);
  scene.send("A1:A1", "A1:A1").path({{-25, 5.5}, {25, 5.5}, {-25, 5.5}, {25, 5.5}});
  const auto landscape = Landscape::make(scene.task(), {});
  ASSERT_TRUE(landscape);
  ASSERT_EQ(landscape->notes().size(), 1U);
  EXPECT_EQ(landscape->notes().front(),
            "a target moves at 4.27 m/s, and not everybody who follows it can walk more than 1.40 m/s");
}

TEST(SwarmLandscape, ATargetInAnObstacleIsAnError) {
  Scene scene(20, 10, {"J4:L6"});
  scene.send("A1:A2", "K5:K6");
  EXPECT_EQ(error_of(scene),
            "the target at (0.50 m, 4.50 m) lies in an obstacle (people stay 0.25 m away from what is blocked)");
}

TEST(SwarmLandscape, ATargetThatCannotBeReachedIsAnError) {
  Scene scene(20, 10, {"J1:J10"});
  scene.send("A1:A2", "P5:P6");
  EXPECT_EQ(error_of(scene),
            "2 targets cannot be reached, for example that at (5.50 m, 5.50 m): what is blocked lies between them and "
            "everybody who may go there (open a way, or move the formation)");
}

TEST(SwarmLandscape, OneOfSeveralTargetsBehindAWallIsAnError) {
  Scene scene(20, 10, {"J1:J10"});
  scene.send("A1:A2", "C1:C1").send("B1:B1", "P5:P5");
  auto& task = scene.task();
  task.from.pop_back();
  task.from.push_back(scene.at("B3"));
  task.to.push_back(scene.at("D1"));
  task.to_group.clear();
  EXPECT_EQ(error_of(scene),
            "1 target cannot be reached, for example that at (5.50 m, 4.50 m): what is blocked lies between it and "
            "everybody who may go there (open a way, or move the formation)");
}

TEST(SwarmLandscape, ATargetsWayThroughAnObstacleIsAnError) {
  Scene scene(20, 10, {"J1:J9"});
  scene.send("A1:A2", "P5:P6").path({{-8.5, 2.5}, {8.5, 2.5}});
  EXPECT_EQ(error_of(scene),
            "the target's way leads through an obstacle, between (-8.50 m, 2.50 m) and (8.50 m, 2.50 m) (lead it "
            "around, 0.25 m away from what is blocked)");
}

TEST(SwarmLandscape, PlacesOfAGroupAreForThatGroup) {
  Scene scene(20, 10);
  scene.send("A1:B1", "S1:T1", 1).send("S5:T5", "A5:B5", 0);
  const auto landscape = Landscape::make(scene.task(), {});
  ASSERT_TRUE(landscape);
  const auto& place = landscape->first_places();
  EXPECT_EQ((std::vector{place[0], place[1]}), (std::vector<std::uint32_t>{0, 1})) << "the least squares do not cross";
  EXPECT_EQ((std::vector{place[2], place[3]}), (std::vector<std::uint32_t>{2, 3}));
  EXPECT_NE(landscape->crowd(0), landscape->crowd(2));
  EXPECT_NE(landscape->exchange_class(0), landscape->exchange_class(2));
}

TEST(SwarmLandscape, TheWayAroundAWallGoesThroughItsGap) {
  Scene scene(20, 10, {"J1:J8"});
  scene.send("E2:E2", "P2:P2");
  const auto landscape = Landscape::make(scene.task(), {});
  ASSERT_TRUE(landscape);
  Point at = scene.at("E2");
  double walked_m = 0;
  for (int n = 0; n < 20 && distance(at, scene.at("P2")) > 0; ++n) {
    const auto way = landscape->toward(0, at, scene.at("P2"), 0);
    ASSERT_TRUE(scene.ways().straight(at, way.at)) << "piece " << n;
    walked_m += distance(at, way.at);
    at = way.at;
  }
  EXPECT_EQ(at, scene.at("P2"));
  // Up to row 9 and down again: at least sqrt(5^2 + 7^2) + sqrt(6^2 + 7^2).
  EXPECT_GT(walked_m, 17);
  EXPECT_LT(walked_m, 20);
}

TEST(SwarmLandscape, TheGroundsCostLetsOnWithTheShareOfSpeedThatIsLeft) {
  Terrain hill;
  hill.slowest = 0.4;
  hill.width = hill.height = 1;
  hill.grey = {255};
  Scene scene(20, 10);
  scene.send("A1:A1", "B1:B1").terrain(hill);
  for (const double k : {1.0, 2.0}) {
    SwarmOptions options;
    options.hardness = k;
    const auto landscape = Landscape::make(scene.task(), options);
    ASSERT_TRUE(landscape);
    EXPECT_NEAR(landscape->ground_cost({0, 5}), 0.6 * std::exp(-k), 1e-15);
    EXPECT_NEAR(1 - landscape->ground_cost({0, 5}) * std::exp(k), 0.4, 1e-15) << "Eq. 10";
  }
}

}  // namespace
}  // namespace footlight::planner::swarm
