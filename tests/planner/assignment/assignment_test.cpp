// SPDX-License-Identifier: Apache-2.0
#include "planner/assignment/assignment.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>

#include "core/rng.hpp"

namespace footlight::planner {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

double price_of(Point a, Point b, WalkCost cost) {
  return cost == WalkCost::squared ? squared_length(a - b) : distance(a, b);
}

std::vector<Point> distinct_cells(std::uint64_t seed, std::size_t count, std::uint64_t side) {
  Rng rng(seed);
  std::vector<Point> cells;
  while (cells.size() < count) {
    const Point p{static_cast<double>(rng.below(side)), static_cast<double>(rng.below(side))};
    if (std::ranges::find(cells, p) == cells.end()) cells.push_back(p);
  }
  return cells;
}

std::optional<double> cheapest_by_trying_all(const std::vector<Point>& a, const std::vector<Point>& b, WalkCost cost,
                                             double longest_m) {
  std::vector<std::size_t> order(a.size());
  std::iota(order.begin(), order.end(), 0U);
  std::optional<double> best;
  do {
    double sum = 0;
    bool allowed = true;
    for (std::size_t i = 0; i < a.size(); ++i) {
      sum += price_of(a[i], b[order[i]], cost);
      allowed = allowed && distance(a[i], b[order[i]]) <= longest_m;
    }
    if (allowed && (!best || sum < *best)) best = sum;
  } while (std::ranges::next_permutation(order).found);
  return best;
}

TEST(Assign, EqualsTryingAllOrdersOnSmallFormations) {
  for (std::uint64_t seed = 0; seed < 120; ++seed) {
    const std::size_t size = 1 + seed % 6;
    const auto a = distinct_cells(seed, size, 4);
    const auto b = distinct_cells(seed + 1000, size, 4);
    for (const WalkCost cost : {WalkCost::squared, WalkCost::euclidean}) {
      for (const double longest_m : {kNoLimit, 2.0}) {
        const auto expected = cheapest_by_trying_all(a, b, cost, longest_m);
        const auto found = assign(a, b, cost, longest_m);
        ASSERT_EQ(found.has_value(), expected.has_value()) << seed;
        if (!expected) continue;
        EXPECT_NEAR(found->cost, *expected, 1e-9) << seed;
        EXPECT_NEAR(found->gap, 0, 1e-9) << seed;
        auto seen = found->target_of;
        std::ranges::sort(seen);
        for (std::size_t i = 0; i < size; ++i) EXPECT_EQ(seen[i], i);
      }
    }
  }
}

}  // namespace
}  // namespace footlight::planner
