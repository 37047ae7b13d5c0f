// SPDX-License-Identifier: Apache-2.0
#include "planner/collective/social_force.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace footlight::planner::collective {
namespace {

TEST(DriveForce, IsOfEquation8) {
  // (1.5 (0.6, 0.8) - (0.5, 0)) / 0.5 by hand.
  const Point force = drive_force({0.5, 0}, {0.6, 0.8}, 1.5, 0.5);
  EXPECT_DOUBLE_EQ(force.x, 0.8);
  EXPECT_DOUBLE_EQ(force.y, 2.4);
  EXPECT_EQ(drive_force({0.6, 0.8}, {0.6, 0.8}, 1, 0.5), Point{}) << "who walks as she wants is left alone";
}

TEST(ObstacleForce, IsOfEquation9) {
  // A wall 1 m to the left of somebody 0.25 m wide on each side: 2 exp(-0.75 / 0.5).
  const Point force = obstacle_force({1, 2}, {0, 2}, 0.25, {2, 0.5});
  EXPECT_NEAR(force.x, 0.44626032029685964, 1e-15);
  EXPECT_DOUBLE_EQ(force.y, 0);
  EXPECT_DOUBLE_EQ(obstacle_force({0.25, 0}, {0, 0}, 0.25, {2, 0.5}).x, 2) << "A where they touch";
}

TEST(RepulseForce, IsOfEquation10AndPointsAway) {
  // 1 m apart along (0.6, 0.8), touching at 0.5 m: 3 exp(-0.5 / 0.25) = 3 e^-2.
  const Point force = repulse_force({0.6, 0.8}, {0, 0}, 0.5, {3, 0.25});
  EXPECT_NEAR(force.x, 0.6 * 0.40600584970983794, 1e-15);
  EXPECT_NEAR(force.y, 0.8 * 0.40600584970983794, 1e-15);
  const Point wide = repulse_force({1.2, 0}, {0, 0}, 0.7, {3, 0.25});
  EXPECT_NEAR(wide.x, 0.40600584970983794, 1e-15) << "wider people repel as much with as much room between them";
}

TEST(CohesionForce, IsBoundedInPlaceOfEquation21) {
  // 0.5 m away with B' = 0.5 m: 2 (1 - 1/e).
  const Point force = cohesion_force({0, -0.5}, {2, 0.5});
  EXPECT_DOUBLE_EQ(force.x, 0);
  EXPECT_NEAR(force.y, -1.2642411176571153, 1e-15);
  EXPECT_EQ(cohesion_force({}, {2, 0.5}), Point{}) << "nobody pulls who is in her place";
  EXPECT_LE(length(cohesion_force({1000, 0}, {2, 0.5})), 2);
  EXPECT_GT(length(cohesion_force({1000, 0}, {2, 0.5})), 1.999);
}

TEST(Feedback, TurnsTheHeadingTowardTheOthersInPlaceOfEquation18) {
  EXPECT_EQ(fed_back_heading({1, 0}, {0, 1}, 0), (Point{1, 0})) << "no information, no feedback";
  const Point half = fed_back_heading({1, 0}, {0, 1}, 0.5);
  EXPECT_NEAR(half.x, std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(half.y, std::sqrt(0.5), 1e-15);
  EXPECT_EQ(fed_back_heading({1, 0}, {0, 1}, 7), (Point{0, 1})) << "no more than all the way";
  EXPECT_EQ(fed_back_heading({1, 0}, {-1, 0}, 0.5), (Point{1, 0})) << "who is torn goes on";
}

TEST(Feedback, MovesTheSpeedTowardTheOthersInPlaceOfEquation19) {
  EXPECT_DOUBLE_EQ(fed_back_speed(1, 2, 0), 1);
  EXPECT_DOUBLE_EQ(fed_back_speed(1, 2, 0.25), 1.25);
  EXPECT_DOUBLE_EQ(fed_back_speed(2, 1, 0.25), 1.75) << "slower, too, which the print cannot";
  EXPECT_DOUBLE_EQ(fed_back_speed(1, 2, 3), 2);
}

}  // namespace
}  // namespace footlight::planner::collective
