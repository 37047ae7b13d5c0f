// SPDX-License-Identifier: Apache-2.0
#include "planner/swarm/equations.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace footlight::planner::swarm {
namespace {

TEST(SwarmEquations, VelocityIsPulledByTheFullDistances) {
  // (2) with w = 1, c1 r1 = 0.25, c2 r2 = 0.5: (1, 2) + 0.25 (4, 0) + 0.5 (0, -2)
  const Point v = next_velocity({1, 2}, {0, 0}, {4, 0}, {0, -2}, {1, 0.25, 0.5});
  EXPECT_DOUBLE_EQ(v.x, 2.0);
  EXPECT_DOUBLE_EQ(v.y, 1.0);
}

TEST(SwarmEquations, InertiaScalesWhatWas) {
  const Point v = next_velocity({1, 2}, {3, 3}, {3, 3}, {3, 3}, {0.5, 1, 1});
  EXPECT_DOUBLE_EQ(v.x, 0.5);
  EXPECT_DOUBLE_EQ(v.y, 1.0);
}

TEST(SwarmEquations, DirectionIsPulledByUnitVectorsWhateverTheDistance) {
  // (6): (1, 0) + 0.25 (0, 1) + 0.5 (0, 1) = (1, 0.75), of length 1.25
  const Point d = next_direction({1, 0}, {2, 2}, {2, 3}, {2, 900}, {1, 0.25, 0.5});
  EXPECT_DOUBLE_EQ(d.x, 0.8);
  EXPECT_DOUBLE_EQ(d.y, 0.6);
}

TEST(SwarmEquations, WhoIsAtHerBestIsNotPulledByIt) {
  const Point d = next_direction({0, 1}, {2, 2}, {2, 2}, {5, 2}, {1, 0.5, 0.75});
  EXPECT_DOUBLE_EQ(d.x, 0.6);
  EXPECT_DOUBLE_EQ(d.y, 0.8);
}

TEST(SwarmEquations, PullsThatCancelLeaveTheDirection) {
  const Point d = next_direction({1, 0}, {0, 0}, {-1, 0}, {-7, 0}, {1, 0.5, 0.5});
  EXPECT_EQ(d, (Point{1, 0}));
}

TEST(SwarmEquations, CostFallsWithTheSquareOfDistanceByBothScopes) {
  // (8): two people of scope 5, (6, 8) apart: exp(-100 / 10^2); twice as far exp(-4)
  EXPECT_NEAR(object_cost((36.0 + 64.0) / (10.0 * 10.0)), 0.36787944117144233, 1e-15);
  EXPECT_NEAR(object_cost(400.0 / 100.0), 0.01831563888873418, 1e-15);
  EXPECT_EQ(object_cost(0), 1);
}

TEST(SwarmEquations, ObjectiveAddsTheWorstObjectAndTheInverseOfTheTarget) {
  // (9): 2 x 0.25 + 1 / exp(-0.5)
  EXPECT_NEAR(objective(2 * 0.25, 0.5), 0.5 + 1.6487212707001282, 1e-15);
  EXPECT_EQ(objective(0, 0), 1) << "on the target, with nothing around";
}

TEST(SwarmEquations, AcceptanceHasAHardBoundaryWhereBothScopesMeet) {
  // (10): 1 - e^-4 e = 1 - e^-3; with k = 2 the boundary moves out to sqrt(2) scopes
  EXPECT_NEAR(acceptance(std::exp(-4.0), 1), 0.950212931632136, 1e-15);
  EXPECT_NEAR(acceptance(std::exp(-1.0), 1), 0, 1e-15);
  EXPECT_EQ(acceptance(std::exp(-0.9), 1), 0);
  EXPECT_NEAR(acceptance(std::exp(-4.0), 2), 0.8646647167633873, 1e-15);
  EXPECT_NEAR(acceptance(object_cost(2.0), 2), 0, 1e-15);
}

TEST(SwarmEquations, SpeedFallsTowardObstaclesAndTowardTheTarget) {
  EXPECT_DOUBLE_EQ(speed_share(0, 1, 10, 1), 1);
  EXPECT_DOUBLE_EQ(speed_share(0, 1, 0.25, 1), 0.25);
  EXPECT_NEAR(speed_share(std::exp(-2.0), 1, 10, 1), 1 - std::exp(-1.0), 1e-15);
  EXPECT_DOUBLE_EQ(speed_share(1, 1, 10, 1), 0.3) << "who touches somebody can leave";
  EXPECT_EQ(speed_share(0, 1, 0, 1), 0);
}

}  // namespace
}  // namespace footlight::planner::swarm
