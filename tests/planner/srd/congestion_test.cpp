// SPDX-License-Identifier: Apache-2.0
#include "planner/srd/congestion.hpp"

#include <gtest/gtest.h>

namespace footlight::planner::srd {
namespace {

TEST(Congestion, IsMinusTwoWhereNobodyIsMinusOneWhereGroupsMeetElseTheGroup) {
  Congestion congestion({0, 0}, {10, 10}, 2);
  const std::vector<Point> at{{1, 1}, {1.9, 1.9}, {2.1, 1}, {5, 5}, {5.5, 5.5}, {9, 9}};
  const std::vector<std::int32_t> group{0, 0, 1, 0, 1, 7};
  congestion.fill(at, group);
  EXPECT_EQ(congestion.value({0.1, 0.1}), 0);   // two of one group
  EXPECT_EQ(congestion.value({3.9, 0.1}), 1);   // beside them another group, in a space of its own
  EXPECT_EQ(congestion.value({4.5, 4.5}), -1);  // both
  EXPECT_EQ(congestion.value({8.5, 8.5}), 7);
  EXPECT_EQ(congestion.value({0.1, 9.9}), -2);
}

TEST(Congestion, ForgetsWhereTheyWere) {
  Congestion congestion({0, 0}, {10, 10}, 2);
  const std::vector<std::int32_t> group{0, 1};
  congestion.fill(std::vector<Point>{{1, 1}, {1, 1.5}}, group);
  congestion.fill(std::vector<Point>{{9, 1}, {1, 9}}, group);
  EXPECT_EQ(congestion.value({1, 1}), -2);
  EXPECT_EQ(congestion.value({9, 1}), 0);
}

TEST(Congestion, IsMetInTheFourNearestSpaces) {
  Congestion congestion({0, 0}, {10, 10}, 2);
  congestion.fill(std::vector<Point>{{3.9, 3.9}, {4.1, 3.9}, {0.5, 9}}, std::vector<std::int32_t>{0, 1, 0});
  // Each in a space of her own, but beside the border between them.
  EXPECT_TRUE(congestion.meets_others({3.9, 3.9}, 0));
  EXPECT_TRUE(congestion.meets_others({4.1, 3.9}, 1));
  EXPECT_FALSE(congestion.meets_others({2.9, 3.9}, 0));  // nearer to the space on her other side
  EXPECT_FALSE(congestion.meets_others({0.5, 9}, 0));
}

TEST(Congestion, IsMixedWhereSomethingMoves) {
  Congestion congestion({0, 0}, {20, 20}, 2);
  congestion.fill(std::vector<Point>{{9, 9}, {1, 19}}, std::vector<std::int32_t>{0, 0});
  congestion.add({{10, 11}, {1, 0}, 1.5});
  EXPECT_EQ(congestion.value({9, 11}), -1);
  EXPECT_EQ(congestion.value({9, 9}), -1);
  EXPECT_EQ(congestion.value({11, 13}), -1);
  EXPECT_EQ(congestion.value({13, 11}), -2);  // begins 2 m from the disc's middle
  EXPECT_EQ(congestion.value({1, 19}), 0);
  EXPECT_TRUE(congestion.meets_others({12.5, 11}, 0));
}

TEST(Congestion, CountsWhoIsOutsideToTheBorder) {
  Congestion congestion({0, 0}, {10, 10}, 2);
  congestion.fill(std::vector<Point>{{-3, -3}}, std::vector<std::int32_t>{4});
  EXPECT_EQ(congestion.value({0, 0}), 4);
}

}  // namespace
}  // namespace footlight::planner::srd
