// SPDX-License-Identifier: Apache-2.0
#include "planner/assignment/assignment.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <set>
#include <utility>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"
#include "planner/assignment/kernels.hpp"
#include "tests/bench/instances.hpp"

namespace footlight::planner {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();
using Points = std::vector<Point>;

double price_of(Point a, Point b, WalkCost cost) {
  return cost == WalkCost::squared ? squared_length(a - b) : distance(a, b);
}

/// Distinct cells of a square field, in random order.
Points distinct_cells(std::uint64_t seed, std::size_t count, std::uint64_t side) {
  Rng rng(seed);
  Points cells;
  std::set<std::pair<double, double>> seen;
  while (cells.size() < count) {
    const Point p{static_cast<double>(rng.below(side)), static_cast<double>(rng.below(side))};
    if (seen.emplace(p.x, p.y).second) cells.push_back(p);
  }
  return cells;
}

Points anywhere(std::uint64_t seed, std::size_t count, double side_m) {
  Rng rng(seed);
  Points points(count);
  for (Point& p : points) p = {side_m * rng.uniform(), side_m * rng.uniform()};
  return points;
}

std::optional<double> cheapest_by_trying_all(const Points& a, const Points& b, WalkCost cost, double longest_m) {
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

/// A perfect matching of allowed walks, its cost, and the proof that none is cheaper, all of it from the points alone.
void expect_proved(const Points& a, const Points& b, WalkCost cost, double longest_m, const Assignment& found) {
  ASSERT_EQ(found.target_of.size(), a.size());
  ASSERT_EQ(found.source_value.size(), a.size());
  ASSERT_EQ(found.target_value.size(), a.size());
  std::vector<int> taken(a.size(), 0);
  double sum = 0;
  double dual = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_LT(found.target_of[i], a.size());
    EXPECT_EQ(taken[found.target_of[i]]++, 0) << "two go to " << found.target_of[i];
    EXPECT_LE(distance(a[i], b[found.target_of[i]]), longest_m);
    sum += price_of(a[i], b[found.target_of[i]], cost);
    dual += found.source_value[i] + found.target_value[i];
  }
  const double tolerance = 1e-9 * (1 + sum);
  EXPECT_NEAR(found.cost, sum, tolerance);
  EXPECT_NEAR(found.gap, 0, tolerance);
  EXPECT_NEAR(dual, sum, tolerance);
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < a.size(); ++j) {
      if (distance(a[i], b[j]) > longest_m) continue;
      worst = std::min(worst, price_of(a[i], b[j], cost) - found.source_value[i] - found.target_value[j]);
    }
  }
  EXPECT_GE(worst, -1e-9 * (1 + sum / static_cast<double>(a.size() + 1)));
}

/// What is there; where nothing is, the test has failed and goes on with nobody.
Assignment answer(std::optional<Assignment> found) {
  if (found) return *std::move(found);
  ADD_FAILURE() << "no assignment";
  return {};
}

constexpr std::array kBothCosts{WalkCost::squared, WalkCost::euclidean};

TEST(Assign, EqualsTryingAllOrdersOnSmallFormations) {
  for (std::uint64_t seed = 0; seed < 120; ++seed) {
    const std::size_t size = 1 + seed % 6;
    const auto a = distinct_cells(seed, size, 4);
    const auto b = distinct_cells(seed + 1000, size, 4);
    for (const WalkCost cost : kBothCosts) {
      for (const double longest_m : {kNoLimit, 2.0}) {
        const auto expected = cheapest_by_trying_all(a, b, cost, longest_m);
        const auto found = assign(a, b, cost, longest_m);
        ASSERT_EQ(found.has_value(), expected.has_value()) << seed;
        if (!expected) continue;
        EXPECT_NEAR(found->cost, *expected, 1e-9) << seed;
        expect_proved(a, b, cost, longest_m, *found);
      }
    }
  }
}

TEST(Assign, ProvesItselfOnFormationsOfManySizes) {
  for (const std::size_t size : {63U, 64U, 65U, 100U, 255U, 256U, 257U, 300U, 700U}) {
    const auto side = static_cast<std::uint64_t>(2 * std::sqrt(static_cast<double>(size))) + 1;
    const auto a = distinct_cells(size, size, side);
    const auto b = distinct_cells(size + 7, size, side);
    for (const WalkCost cost : kBothCosts) {
      const auto found = assign(a, b, cost, kNoLimit);
      ASSERT_TRUE(found.has_value());
      expect_proved(a, b, cost, kNoLimit, *found);
      if (cost == WalkCost::squared) {
        EXPECT_EQ(found->gap, 0.0);
      }
    }
  }
}

TEST(Assign, EqualsTheSparseOneOverAllAllowedPairs) {
  int infeasible = 0;
  int feasible = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const std::size_t size = 70 + 15 * seed;
    const auto a = distinct_cells(seed, size, 30);
    const auto b = distinct_cells(seed + 50, size, 30);
    for (const WalkCost cost : kBothCosts) {
      for (const double longest_m : {3.0, 5.0, 8.0, 12.0}) {
        std::vector<Arc> arcs;
        for (std::uint32_t i = 0; i < size; ++i) {
          for (std::uint32_t j = 0; j < size; ++j) {
            if (distance(a[i], b[j]) <= longest_m) arcs.push_back({i, j, price_of(a[i], b[j], cost)});
          }
        }
        const auto expected = assign_sparse(static_cast<std::uint32_t>(size), arcs);
        const auto found = assign(a, b, cost, longest_m);
        ASSERT_EQ(found.has_value(), expected.has_value()) << size << ' ' << longest_m;
        if (!found) {
          ++infeasible;
          continue;
        }
        ++feasible;
        EXPECT_NEAR(found->cost, expected->cost, 1e-9 * expected->cost);
        expect_proved(a, b, cost, longest_m, *found);
        expect_proved(a, b, cost, longest_m, *expected);
      }
    }
  }
  EXPECT_GT(infeasible, 5);
  EXPECT_GT(feasible, 20);
}

TEST(Assign, ALongestWalkThatBindsAsksForLittleMoreThanNone) {
  const auto [a, b] = bench::wandering_hole(5200);
  const auto free = assign(a, b, WalkCost::squared, kNoLimit);
  double longest_m = 0;
  for (std::size_t i = 0; i < a.size(); ++i) longest_m = std::max(longest_m, distance(a[i], b[free->target_of[i]]));
  const auto found = assign(a, b, WalkCost::squared, 0.8 * longest_m);
  ASSERT_TRUE(found.has_value());
  EXPECT_GT(found->cost, free->cost);
  EXPECT_EQ(found->gap, 0);
  EXPECT_LT(2 * found->looked_at, 3 * free->looked_at);
}

TEST(Assign, WhoCanReachOneTargetOnlyGoesThere) {
  Points a;
  Points b;
  for (int i = 0; i < 400; ++i) {
    a.push_back({10.0 * (i % 20), 10.0 * (i / 20)});
    b.push_back(a.back() + Point{i % 3 == 0 ? 2.0 : -1.0, 1.0});
  }
  for (const WalkCost cost : kBothCosts) {
    const auto found = assign(a, b, cost, 2.5);
    ASSERT_TRUE(found.has_value());
    for (std::uint32_t i = 0; i < a.size(); ++i) EXPECT_EQ(found->target_of[i], i);
    expect_proved(a, b, cost, 2.5, *found);
    EXPECT_FALSE(assign(a, b, cost, 2.0).has_value());
  }
}

TEST(Assign, ThereIsNoAnswerWhenNobodyWantsItAnyMore) {
  const std::atomic<bool> stopped = true;
  const auto a = distinct_cells(1, 300, 40);
  const auto b = distinct_cells(2, 300, 40);
  for (const WalkCost cost : kBothCosts) {
    EXPECT_FALSE(assign(a, b, cost, kNoLimit, &stopped).has_value());
    EXPECT_FALSE(assign(a, b, cost, 30, &stopped).has_value());
  }
}

TEST(Assign, TakesPointsThatLieOnNoGrid) {
  for (const std::size_t size : {5U, 90U, 400U}) {
    const auto a = anywhere(size, size, 40);
    const auto b = anywhere(size + 1, size, 40);
    for (const WalkCost cost : kBothCosts) {
      const auto found = assign(a, b, cost, kNoLimit);
      ASSERT_TRUE(found.has_value());
      expect_proved(a, b, cost, kNoLimit, *found);
    }
  }
}

TEST(Assign, IsExactOnEveryKindOfGrid) {
  for (const GridKind kind : {GridKind::square, GridKind::hexagonal, GridKind::triangular}) {
    const auto grid = Grid::make(kind, 40, 40, 0.73);
    ASSERT_TRUE(grid.has_value());
    Points a;
    Points b;
    for (const Point p : distinct_cells(3, 350, 40)) {
      a.push_back(grid.value().centre(Cell{static_cast<int>(p.x), static_cast<int>(p.y)}));
    }
    for (const Point p : distinct_cells(4, 350, 40)) {
      b.push_back(grid.value().centre(Cell{static_cast<int>(p.x), static_cast<int>(p.y)}));
    }
    const auto found = assign(a, b, WalkCost::squared, kNoLimit);
    ASSERT_TRUE(found.has_value());
    EXPECT_EQ(found->gap, 0.0) << to_text(kind);
    expect_proved(a, b, WalkCost::squared, kNoLimit, *found);
  }
}

TEST(Assign, AnswersForNobodyAndForOne) {
  const Assignment nobody = answer(assign({}, {}, WalkCost::squared, kNoLimit));
  EXPECT_TRUE(nobody.target_of.empty());
  EXPECT_EQ(nobody.cost, 0);
  const Points a{{1, 1}};
  const Points b{{4, 5}};
  EXPECT_EQ(answer(assign(a, b, WalkCost::squared, kNoLimit)).cost, 25);
  EXPECT_EQ(answer(assign(a, b, WalkCost::euclidean, 5.0)).cost, 5);
  EXPECT_FALSE(assign(a, b, WalkCost::euclidean, 4.9).has_value());
}

TEST(Assign, LeavesIdenticalFormationsAlone) {
  const auto a = distinct_cells(1, 500, 40);
  for (const WalkCost cost : kBothCosts) {
    for (const double longest_m : {kNoLimit, 0.0}) {
      const auto found = assign(a, a, cost, longest_m);
      ASSERT_TRUE(found.has_value());
      EXPECT_EQ(found->cost, 0);
      for (std::uint32_t i = 0; i < a.size(); ++i) EXPECT_EQ(found->target_of[i], i);
    }
  }
}

TEST(Assign, WalksAlongALineInOrder) {
  Points a;
  Points b;
  for (int i = 0; i < 200; ++i) {
    a.push_back({2.0 * i, 5});
    b.push_back({1000.0 - 3 * i, 5});
  }
  const Assignment found = answer(assign(a, b, WalkCost::squared, kNoLimit));
  ASSERT_EQ(found.target_of.size(), 200U);
  for (std::uint32_t i = 0; i < 200; ++i) EXPECT_EQ(found.target_of[i], 199 - i);
  expect_proved(a, b, WalkCost::euclidean, kNoLimit, answer(assign(a, b, WalkCost::euclidean, kNoLimit)));
}

TEST(Assign, KeepsFarClustersApart) {
  auto a = distinct_cells(1, 100, 15);
  auto b = distinct_cells(2, 100, 15);
  for (const Point p : distinct_cells(3, 100, 15)) a.push_back(p + Point{9e4, 8e4});
  for (const Point p : distinct_cells(4, 100, 15)) b.push_back(p + Point{9e4, 8e4});
  for (const WalkCost cost : kBothCosts) {
    const auto found = assign(a, b, cost, kNoLimit);
    ASSERT_TRUE(found.has_value());
    expect_proved(a, b, cost, kNoLimit, *found);
    for (std::uint32_t i = 0; i < 200; ++i) EXPECT_EQ(found->target_of[i] < 100, i < 100);
  }
}

struct Known {
  bench::Scene scene;
  int people;
  double squared;
  double euclidean;
};

/// By LEMON's NetworkSimplex: footlight_bench --benchmark_filter='peer/.*/(330|1000)/' (counter "cost").
constexpr std::array<Known, 6> kByNetworkSimplex{{
    {bench::Scene::disk_to_ring, 330, 4072, 1100.446745894},
    {bench::Scene::disk_to_ring, 1000, 35740, 5725.971350880},
    {bench::Scene::block_to_letters, 330, 8812, 1539.885391222},
    {bench::Scene::block_to_letters, 1000, 74797, 7869.826591321},
    {bench::Scene::flower_turned, 330, 836, 383.734652878},
    {bench::Scene::flower_turned, 1000, 7213, 2064.916203270},
}};

TEST(Assign, EqualsNetworkSimplexOnFormations) {
  for (const Known& known : kByNetworkSimplex) {
    const auto instance = bench::make_instance(known.scene, known.people);
    const auto squared = assign(instance.sources, instance.targets, WalkCost::squared, kNoLimit);
    ASSERT_TRUE(squared.has_value());
    EXPECT_EQ(squared->cost, known.squared) << bench::to_text(known.scene) << ' ' << known.people;
    EXPECT_EQ(squared->gap, 0.0);
    const auto euclidean = assign(instance.sources, instance.targets, WalkCost::euclidean, kNoLimit);
    ASSERT_TRUE(euclidean.has_value());
    EXPECT_NEAR(euclidean->cost, known.euclidean, 1e-8 * known.euclidean)
        << bench::to_text(known.scene) << ' ' << known.people;
  }
}

/// Two formations of 1 to 120 people on a field just large enough to be crowded.
struct Pair {
  Points a;
  Points b;
};

Pair any_pair() {
  const auto people = *rc::gen::inRange<std::size_t>(1, 120);
  const auto side = static_cast<std::uint64_t>(std::sqrt(2.0 * static_cast<double>(people))) + 1;
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  return {distinct_cells(seed, people, side), distinct_cells(seed + 1, people, side)};
}

TEST(AssignProperty, ProvesItself) {
  EXPECT_TRUE(rc::check([] {
    const auto [a, b] = any_pair();
    const auto cost = *rc::gen::elementOf(std::vector{WalkCost::squared, WalkCost::euclidean});
    const double longest_m = *rc::gen::elementOf(std::vector{kNoLimit, 3.0, 6.0, 10.0});
    const auto found = assign(a, b, cost, longest_m);
    RC_ASSERT(found.has_value() || longest_m < kNoLimit);
    if (found) expect_proved(a, b, cost, longest_m, *found);
    RC_ASSERT(!::testing::Test::HasFailure());
  }));
}

TEST(AssignProperty, TheOrderOfThePeopleDoesNotChangeTheCost) {
  EXPECT_TRUE(rc::check([] {
    auto [a, b] = any_pair();
    const auto before = assign(a, b, WalkCost::squared, kNoLimit);
    std::ranges::reverse(a);
    std::ranges::rotate(b, b.begin() + static_cast<std::ptrdiff_t>(*rc::gen::inRange<std::size_t>(0, b.size())));
    RC_ASSERT(assign(a, b, WalkCost::squared, kNoLimit)->cost == before->cost);
  }));
}

TEST(AssignProperty, MovingAllTargetsKeepsTheSquaredAssignmentOptimal) {
  EXPECT_TRUE(rc::check([] {
    auto [a, b] = any_pair();
    const auto before = assign(a, b, WalkCost::squared, kNoLimit);
    const Point by{0.25 * *rc::gen::inRange(-400, 400), 0.25 * *rc::gen::inRange(-400, 400)};
    for (Point& p : b) p = p + by;
    const auto after = assign(a, b, WalkCost::squared, kNoLimit);
    RC_ASSERT(after->gap == 0.0);
    double kept = 0;
    for (std::size_t i = 0; i < a.size(); ++i) kept += squared_length(a[i] - b[before->target_of[i]]);
    RC_ASSERT(std::abs(kept - after->cost) <= 1e-12 * kept);
  }));
}

TEST(AssignProperty, WhoStandsOnATargetMayStayThereWhenDistancesAreSummed) {
  EXPECT_TRUE(rc::check([] {
    const auto [a, b] = any_pair();
    const auto found = assign(a, b, WalkCost::euclidean, kNoLimit);
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (std::ranges::find(b, a[i]) != b.end()) RC_ASSERT(b[found->target_of[i]] == a[i]);
    }
    std::vector<Arc> all;  // and the optimum over all pairs, where nobody is made to stay, is no lower
    for (std::uint32_t i = 0; i < a.size(); ++i) {
      for (std::uint32_t j = 0; j < b.size(); ++j) all.push_back({i, j, distance(a[i], b[j])});
    }
    const auto free = assign_sparse(static_cast<std::uint32_t>(a.size()), all);
    RC_ASSERT(std::abs(free->cost - found->cost) <= 1e-9 * (1 + free->cost));
  }));
}

TEST(AssignProperty, AnswersTheSameEachTime) {
  EXPECT_TRUE(rc::check([] {
    const auto [a, b] = any_pair();
    for (const WalkCost cost : kBothCosts) {
      RC_ASSERT(assign(a, b, cost, 7.0).has_value() == assign(a, b, cost, 7.0).has_value());
      RC_ASSERT(assign(a, b, cost, kNoLimit)->target_of == assign(a, b, cost, kNoLimit)->target_of);
    }
  }));
}

/// Both formations by all instructions that this processor has; the bytes of the answers are compared.
void expect_same_bytes(const Points& a, const Points& b, WalkCost cost, double longest_m) {
  using assignment::Instructions;
  assignment::use_instructions(Instructions::generic);
  const auto expected = assign(a, b, cost, longest_m);
  for (const Instructions instructions : {Instructions::avx512, Instructions::avx2}) {
    if (!assignment::has_instructions(instructions)) continue;
    assignment::use_instructions(instructions);
    const auto found = assign(a, b, cost, longest_m);
    ASSERT_EQ(found.has_value(), expected.has_value());
    if (!found) continue;
    EXPECT_EQ(found->target_of, expected->target_of);
    EXPECT_EQ(found->source_value, expected->source_value);
    EXPECT_EQ(found->target_value, expected->target_value);
    EXPECT_EQ(found->cost, expected->cost);
  }
  for (const Instructions widest : {Instructions::avx2, Instructions::avx512}) {
    if (assignment::has_instructions(widest)) assignment::use_instructions(widest);
  }
}

TEST(AssignInstructions, AllGiveTheSameBytes) {
  for (const auto scene : bench::kScenes) {
    const auto instance = bench::make_instance(scene, 1000);
    for (const WalkCost cost : kBothCosts) {
      expect_same_bytes(instance.sources, instance.targets, cost, kNoLimit);
      expect_same_bytes(instance.sources, instance.targets, cost, 15.0);
    }
  }
  for (const std::size_t size : {7U, 60U, 150U, 500U}) {
    for (const WalkCost cost : kBothCosts) {
      expect_same_bytes(anywhere(size, size, 40), anywhere(size + 1, size, 40), cost, kNoLimit);
    }
  }
}

/// Costs as a blocked way makes them: nobody may cross the middle but by a gap, so that walks are longer than straight.
std::vector<Arc> around_a_wall(const Points& a, const Points& b) {
  const Point gap{20.3, 20};
  std::vector<Arc> arcs;
  for (std::uint32_t i = 0; i < a.size(); ++i) {
    for (std::uint32_t j = 0; j < b.size(); ++j) {
      const bool crosses = (a[i].x < gap.x) != (b[j].x < gap.x);
      const double walk = crosses ? distance(a[i], gap) + distance(gap, b[j]) : distance(a[i], b[j]);
      if (walk < 25) arcs.push_back({i, j, walk * walk});
    }
  }
  return arcs;
}

TEST(AssignSparse, ProvesItselfWhereAWayIsBlocked) {
  for (const std::size_t size : {20U, 150U, 400U}) {
    const auto a = distinct_cells(size, size, 40);
    const auto b = distinct_cells(size + 1, size, 40);
    const auto arcs = around_a_wall(a, b);
    const Assignment found = answer(assign_sparse(static_cast<std::uint32_t>(size), arcs));
    std::vector<int> taken(size, 0);
    double sum = 0;
    double dual = 0;
    double worst = 0;
    for (const Arc& arc : arcs) {
      worst = std::min(worst, arc.cost - found.source_value[arc.source] - found.target_value[arc.target]);
      if (found.target_of[arc.source] == arc.target) sum += arc.cost;
    }
    for (std::size_t i = 0; i < size; ++i) {
      EXPECT_EQ(taken[found.target_of[i]]++, 0);
      dual += found.source_value[i] + found.target_value[i];
    }
    EXPECT_GE(worst, -1e-9 * sum);
    EXPECT_NEAR(dual, sum, 1e-9 * sum) << size;
    EXPECT_NEAR(found.cost, sum, 1e-9 * sum);
    EXPECT_EQ(found.gap, 0);
  }
}

TEST(AssignInstructions, TheGenericOnesAreAlwaysThere) {
  EXPECT_TRUE(assignment::has_instructions(assignment::Instructions::generic));
}

TEST(AssignSparse, RefusesTwoWhoHaveOneTarget) {
  const std::vector<Arc> arcs{{0, 0, 1}, {0, 1, 1}, {1, 2, 1}, {2, 2, 5}};
  EXPECT_FALSE(assign_sparse(3, arcs).has_value());
  EXPECT_FALSE(assign_sparse(2, std::vector<Arc>{{0, 0, 1}}).has_value());
}

TEST(AssignSparse, TakesCostsOfAnySignAndSize) {
  const std::vector<Arc> arcs{{0, 0, -5}, {0, 1, 1e6}, {1, 0, -1e6}, {1, 1, 2.5}};
  const Assignment found = answer(assign_sparse(2, arcs));
  EXPECT_NEAR(found.cost, -2.5, 1e-9);
  EXPECT_EQ(found.target_of, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_TRUE(assign_sparse(0, {}).has_value());
}

}  // namespace
}  // namespace footlight::planner
