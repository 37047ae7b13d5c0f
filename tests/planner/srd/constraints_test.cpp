// SPDX-License-Identifier: Apache-2.0
#include "planner/srd/constraints.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace footlight::planner::srd {
namespace {

TEST(Separation, TwoPeopleShareWhatTheyAreTooNear) {
  const auto i = separation({0.3, 0}, {0, 0}, 0.5);
  ASSERT_TRUE(i);
  EXPECT_NEAR(i->x, 0.1, 1e-12);  // half of 0.2 m
  EXPECT_EQ(i->y, 0);
  const auto j = separation({0, 0}, {0.3, 0}, 0.5);
  ASSERT_TRUE(j);
  EXPECT_EQ(*j, -1 * *i);
}

TEST(Separation, WhoMeetsAThingMovesAllOfIt) {
  const auto one = separation({0, 0.4}, {0, 0}, 1, 1);
  ASSERT_TRUE(one);
  EXPECT_NEAR(one->y, 0.6, 1e-12);
}

TEST(Separation, AsksNothingOfPeopleApart) {
  EXPECT_FALSE(separation({0.5, 0}, {0, 0}, 0.5));
  EXPECT_FALSE(separation({7, 0}, {0, 0}, 0.5));
  EXPECT_FALSE(separation({1, 1}, {1, 1}, 0.5));  // no direction
}

TEST(FormationConstraint, MovesThePersonAloneToHerDestination) {
  EXPECT_EQ(formation({1, 2}, {4, 6}, 1), (Point{3, 4}));
  EXPECT_EQ(formation({1, 2}, {4, 6}, 0.5), (Point{1.5, 2}));
  EXPECT_EQ(formation({4, 6}, {4, 6}, 1), (Point{0, 0}));
}

TEST(Touch, IsWhenTwoDiscsMeet) {
  // 10 m apart, 2 m/s toward each other, discs of 1 m together.
  EXPECT_NEAR(*touch_s({{0, 0}, {1, 0}}, {{10, 0}, {-1, 0}}, 1), 4.5, 1e-12);
  // One passes the other's side by 0.6 m: the discs touch 0.8 m before they are abreast.
  EXPECT_NEAR(*touch_s({{0, 0}, {1, 0}}, {{10, 0.6}, {0, 0}}, 1), 9.2, 1e-12);
}

TEST(Touch, IsNotWhereTheyPassOrPart) {
  EXPECT_FALSE(touch_s({{0, 0}, {1, 0}}, {{10, 1.01}, {0, 0}}, 1));
  EXPECT_FALSE(touch_s({{0, 0}, {-1, 0}}, {{10, 0}, {0, 0}}, 1));
  EXPECT_FALSE(touch_s({{0, 0}, {1, 0}}, {{10, 0}, {1, 0}}, 1));
  EXPECT_FALSE(touch_s({{0, 0}, {-1, 0}}, {{0.5, 0}, {0, 0}}, 1));  // they overlap and part
}

TEST(Touch, IsNowWhereTheyTouchAndGoOn) {
  EXPECT_EQ(touch_s({{0, 0}, {1, 0}}, {{1, 0}, {0, 0}}, 1), 0);
  EXPECT_EQ(touch_s({{0, 0}, {1, 0}}, {{0.5, 0}, {0, 0}}, 1), 0);
}

TEST(Avoidance, OfTwoWhoWalkStraightAtEachOtherBothPassOnTheirRight) {
  const Moving i{{0, 0}, {1, 0}};
  const Moving j{{10, 0}, {-1, 0}};
  const auto of_i = avoidance(i, j, 1, 0.4, 5, 0.5);
  const auto of_j = avoidance(j, i, 1, 0.4, 5, 0.5);
  ASSERT_TRUE(of_i && of_j);
  // They touch after 4.5 s, a step of 0.4 s later they are 0.2 m apart: C = 0.8 m.
  const double expected_m = 0.5 * 0.5 * std::exp(-4.5 * 4.5 / 5) * 0.8;
  EXPECT_NEAR(of_i->x, 0, 1e-12);
  EXPECT_NEAR(of_i->y, -expected_m, 1e-12);
  EXPECT_NEAR(of_j->x, 0, 1e-12);
  EXPECT_NEAR(of_j->y, expected_m, 1e-12);
}

TEST(Avoidance, WhoWouldPassOnOneSideGoesFartherToThatSide) {
  // The other is to my left: I go to the right, and a little forward, across the contact.
  const auto one = avoidance({{0, 0}, {1, 0}}, {{10, 0.6}, {0, 0}}, 1, 1, 20, 1, 1);
  ASSERT_TRUE(one);
  // Contact at 9.2 s: i is at (9.2, 0), (-0.8, -0.6) from the other; across that (0.6, -0.8). A second later she is
  // (0.2, -0.6) from the other.
  const double expected_m = std::exp(-9.2 * 9.2 / 20) * (1 - std::sqrt(0.4));
  EXPECT_NEAR(one->x, 0.6 * expected_m, 1e-12);
  EXPECT_NEAR(one->y, -0.8 * expected_m, 1e-12);
}

TEST(Avoidance, BeginsAtTheHorizon) {
  const Moving i{{0, 0}, {1, 0}};
  const Moving j{{10, 0}, {-1, 0}};
  EXPECT_FALSE(avoidance(i, j, 1, 0.4, 4.4, 1));
  EXPECT_TRUE(avoidance(i, j, 1, 0.4, 4.6, 1));
}

TEST(Seek, LeadsToTheDestinationAndSlowsDownThere) {
  const Point far = seek({0, 0}, {30, 40}, {0, 0}, 1, 1.5);  // as fast as she can
  EXPECT_NEAR(far.x, 0.9, 1e-12);
  EXPECT_NEAR(far.y, 1.2, 1e-12);
  EXPECT_EQ(seek({0, 0}, {0.3, 0}, {0, 0}, 1, 1.5), (Point{0.3, 0}));  // to be there in a second
  EXPECT_EQ(seek({2, 2}, {2, 2}, {0.7, 0}, 1, 1.5), (Point{0.7, 0}));  // with it, once there
}

}  // namespace
}  // namespace footlight::planner::srd
