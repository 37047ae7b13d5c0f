// SPDX-License-Identifier: Apache-2.0
#include "planner/repair/exchange.hpp"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"
#include "planner/repair/closest_approach.hpp"

namespace footlight::planner {
namespace {

struct Crowd {
  std::vector<Point> sources;
  std::vector<Point> targets;
  std::vector<std::uint32_t> target_of;
  [[nodiscard]] double squares() const {
    double sum = 0;
    for (std::size_t i = 0; i < sources.size(); ++i) sum += squared_length(sources[i] - targets[target_of[i]]);
    return sum;
  }
  [[nodiscard]] std::vector<Walk> walks() const {
    std::vector<Walk> out;
    for (std::size_t i = 0; i < sources.size(); ++i) out.push_back({sources[i], targets[target_of[i]]});
    return out;
  }
};

Crowd random_crowd(const Grid& grid, std::size_t people, Rng& rng) {
  Crowd crowd;
  for (auto* side : {&crowd.sources, &crowd.targets}) {
    std::vector<int> cells(static_cast<std::size_t>(grid.size()));
    std::iota(cells.begin(), cells.end(), 0);
    for (std::size_t i = 0; i < people; ++i) {
      std::swap(cells[i], cells[i + rng.below(cells.size() - i)]);
      side->push_back(grid.centre(CellIndex::of(cells[i])));
    }
  }
  crowd.target_of.resize(people);
  std::iota(crowd.target_of.begin(), crowd.target_of.end(), 0U);
  return crowd;
}

bool anybody(Point, Point) { return true; }

TEST(Exchange, TwoWhoWalkThroughEachOtherStayApart) {
  Crowd crowd{{{0, 0}, {4, 0}}, {{4, 0}, {0, 0}}, {0, 1}};
  const Exchanged done = exchange(crowd.sources, crowd.targets, crowd.target_of, 0.7, anybody);
  EXPECT_EQ(done.exchanges, 1);
  EXPECT_EQ(crowd.target_of, (std::vector<std::uint32_t>{1, 0}));
  EXPECT_DOUBLE_EQ(done.squares_saved_m2, 32);
}

TEST(Exchange, LowersTheSumOfSquaresByWhatItSaysAndLeavesTheBound) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    const Grid grid = *Grid::make(static_cast<GridKind>(rng.below(3)), 12, 12, 1.0);
    Crowd crowd = random_crowd(grid, 2 + rng.below(90), rng);
    const double before = crowd.squares();
    const double bound = grid.clearance_bound_m();
    const Exchanged done = exchange(crowd.sources, crowd.targets, crowd.target_of, bound, anybody);
    RC_ASSERT(done.squares_saved_m2 >= 0);
    RC_ASSERT(std::abs(before - done.squares_saved_m2 - crowd.squares()) < 1e-6 * (1 + before));
    RC_ASSERT((done.exchanges > 0) == (done.squares_saved_m2 > 0));
    auto order = crowd.target_of;
    std::sort(order.begin(), order.end());
    for (std::uint32_t i = 0; i < order.size(); ++i) RC_ASSERT(order[i] == i);
    RC_ASSERT(near_pairs(crowd.walks(), bound - 1e-9).empty());
  }));
}

TEST(Exchange, NeverMakesAWalkThatMayNotBeWalked) {
  Crowd crowd{{{0, 0}, {4, 0}}, {{4, 0}, {0, 0}}, {0, 1}};
  const auto away = [](Point from, Point to) { return distance(from, to) > 1; };
  EXPECT_EQ(exchange(crowd.sources, crowd.targets, crowd.target_of, 0.7, away).exchanges, 0);
  EXPECT_EQ(crowd.target_of, (std::vector<std::uint32_t>{0, 1}));
}

TEST(Exchange, PeopleOfTwoKindsKeepTheirTargets) {
  Crowd crowd{{{0, 0}, {4, 0}}, {{4, 0}, {0, 0}}, {0, 1}};
  const std::vector<std::uint32_t> two{7, 3};
  EXPECT_EQ(exchange(crowd.sources, crowd.targets, crowd.target_of, 0.7, anybody, two).exchanges, 0);
  EXPECT_EQ(crowd.target_of, (std::vector<std::uint32_t>{0, 1}));
  const std::vector<std::uint32_t> one{7, 7};
  EXPECT_EQ(exchange(crowd.sources, crowd.targets, crowd.target_of, 0.7, anybody, one).exchanges, 1);
}

}  // namespace
}  // namespace footlight::planner
