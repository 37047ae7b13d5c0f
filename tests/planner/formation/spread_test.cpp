// SPDX-License-Identifier: Apache-2.0
#include "planner/formation/spread.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"

namespace footlight::planner {
namespace {

std::vector<Point> scattered(std::size_t count, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<Point> out;
  for (std::size_t i = 0; i < count; ++i) out.push_back({20 * rng.uniform() - 10, 10 * rng.uniform()});
  return out;
}

double by_all_pairs(const std::vector<Point>& points) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) least = std::min(least, distance(points[i], points[j]));
  }
  return least;
}

TEST(LeastDistance, IsThatOfTheNearestPair) {
  EXPECT_TRUE(rc::check([] {
    const auto points = scattered(*rc::gen::inRange<std::size_t>(2, 60), *rc::gen::arbitrary<std::uint64_t>());
    RC_ASSERT(std::abs(least_distance(points) - by_all_pairs(points)) < 1e-12);
  }));
}

TEST(LeastDistance, IsZeroForOnePlaceTwiceAndInfiniteForOnePoint) {
  EXPECT_EQ(least_distance(std::vector<Point>{{1, 2}, {1, 2}}), 0);
  EXPECT_EQ(least_distance(std::vector<Point>{{1, 2}}), std::numeric_limits<double>::infinity());
}

TEST(LeastDistance, FindsTwoFarPointsAndAPairThatIsFarFromTheRest) {
  EXPECT_DOUBLE_EQ(least_distance(std::vector<Point>{{0, 0}, {300, 400}}), 500);
  EXPECT_DOUBLE_EQ(least_distance(std::vector<Point>{{0, 0}, {1000, 0}, {1000, 3}, {0, 50}}), 3);
}

TEST(Thin, LeavesExactlyAsManyAsWantedOfThePointsGiven) {
  EXPECT_TRUE(rc::check([] {
    const auto points = scattered(*rc::gen::inRange<std::size_t>(1, 300), *rc::gen::arbitrary<std::uint64_t>());
    const auto wanted = *rc::gen::inRange<std::size_t>(1, points.size() + 1);
    const auto left = thin(points, wanted, 0);
    RC_ASSERT(left.size() == wanted);
    for (const Point p : left) RC_ASSERT(std::find(points.begin(), points.end(), p) != points.end());
    RC_ASSERT(left == thin(points, wanted, 0));
  }));
}

TEST(Thin, KeepsTheDistanceAndLeavesFewerWhereItMust) {
  const auto points = scattered(2000, 5);
  const auto left = thin(points, 500, 0.8);
  EXPECT_LT(left.size(), 500U);
  EXPECT_GE(least_distance(left), 0.8 - 1e-9);
}

TEST(Thin, SpreadsWhatIsLeftWiderThanChanceDoes) {
  const auto points = scattered(2000, 7);
  const auto left = thin(points, 100, 0);
  // A hundred places in 200 m2: a square lattice has 1.41 m from one to the next.
  EXPECT_GT(least_distance(left), 0.9);
}

TEST(Thin, LeavesOutTheLaterOfTheTwoNearestUntilTheNumberIsExact) {
  // At 2 m or less all are left, above it two: the step between is made one by one.
  const std::vector<Point> points{{0, 0}, {2, 0}, {4, 0}, {6, 0}};
  EXPECT_EQ(thin(points, 3, 0), (std::vector<Point>{{0, 0}, {2, 0}, {4, 0}}));
}

TEST(Thin, OfALatticeIsQuickWhereItsNumberJumps) {
  std::vector<Point> points;
  for (int x = 0; x < 300; ++x) {
    for (int y = 0; y < 300; ++y) points.push_back({static_cast<double>(x), static_cast<double>(y)});
  }
  EXPECT_EQ(thin(points, 30'000, 0).size(), 30'000U);
}

}  // namespace
}  // namespace footlight::planner
