// SPDX-License-Identifier: Apache-2.0
#include "planner/collective/pairing.hpp"

#include <cmath>
#include <numeric>
#include <set>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"
#include "planner/assignment/dense.hpp"
#include "tests/planner/collective/task_builder.hpp"

namespace footlight::planner::collective {
namespace {

struct People {
  std::vector<Point> from, to;
  std::vector<double> radius_m, speed_mps;

  [[nodiscard]] PairingTask task(const WalkField* around = nullptr) const {
    return {from, to, radius_m, speed_mps, around, nullptr};
  }
};

People people_of(std::vector<Point> from, std::vector<Point> to) {
  People out{std::move(from), std::move(to), {}, {}};
  out.radius_m.assign(out.from.size(), 0.25);
  out.speed_mps.assign(out.from.size(), 1.4);
  return out;
}

CollectiveOptions with(CollectiveOptions::Pairing kind, double lambda = 0.5) {
  CollectiveOptions out;
  out.pairing = kind;
  out.lambda = lambda;
  return out;
}

TEST(MeanEdges, AreOfEquation4) {
  // A square of 2 m with a point in its middle: the middle has four edges of sqrt 2, a corner two sides and one of
  // those.
  const std::vector<double> found = mean_edges_m(std::vector<Point>{{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 1}});
  EXPECT_NEAR(found[4], std::sqrt(2), 1e-12);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(found[static_cast<std::size_t>(i)], (2 + 2 + std::sqrt(2)) / 3, 1e-12);
}

TEST(MeanEdges, AreAllAlikeInsideOfALattice) {
  const Grid grid = *Grid::make(GridKind::square, 8, 8, 1);
  const std::vector<double> found = mean_edges_m(tests::block_of(grid, {0, 0}, 8, 8));
  for (const double edge : found)
    EXPECT_DOUBLE_EQ(edge, 1) << "the diagonals of a square are in no triangulation or in any";
}

TEST(PairCosts, AreOfEquation3) {
  // Triangles: all edges of a corner are averaged. From (0,0), (1,0), (0,1): deltas (1 + 1) / 2 = 1 for the first. To
  // (10,0), (13,0), (10,3): the first has 3.
  const People people = people_of({{0, 0}, {1, 0}, {0, 1}}, {{10, 0}, {13, 0}, {10, 3}});
  const PairCosts costs(people.task(), with(CollectiveOptions::Pairing::least_effort, 0.25));
  EXPECT_NEAR(costs.cost(0, 0), 0.25 * 100 + 0.75 * (1 - 3) * (1 - 3), 1e-9);
  EXPECT_NEAR(costs.cost(0, 2), 0.25 * 109 + 0.75 * std::pow(1 - (3 + 3 * std::sqrt(2)) / 2, 2), 1e-9);
  const PairCosts straight(people.task(), with(CollectiveOptions::Pairing::euclidean));
  EXPECT_NEAR(straight.cost(0, 2), std::sqrt(109), 1e-12);
  const PairCosts blocks(people.task(), with(CollectiveOptions::Pairing::manhattan));
  EXPECT_NEAR(blocks.cost(1, 2), 9 + 3, 1e-12);
}

TEST(PairCosts, WeighTheWaysOfSlowPeopleMoreAndGiveWidePeopleRoom) {
  People people = people_of({{0, 0}, {1, 0}, {0, 1}}, {{10, 0}, {10.5, 0}, {10, 0.5}});
  people.speed_mps[1] = 0.7;
  const PairCosts slow(people.task(), with(CollectiveOptions::Pairing::euclidean));
  EXPECT_NEAR(slow.cost(0, 0), 10, 1e-12);
  EXPECT_NEAR(slow.cost(1, 0), 18, 1e-12) << "9 m at half the speed";
  people.speed_mps[1] = 1.4;
  people.radius_m[0] = 0.5;
  const PairCosts wide(people.task(), with(CollectiveOptions::Pairing::least_effort, 0));
  EXPECT_NEAR(wide.cost(0, 0), std::pow(1 - 0.5, 2) + std::pow(2 * 0.5 - 0.5, 2), 1e-12)
      << "the place's neighbours are half a metre away, she is a metre wide";
}

/// Least cost over all permutations, by Jonker and Volgenant on whole numbers.
double dense_least(const PairCosts& costs) {
  constexpr double kScale = 1 << 20U;
  assignment::CostTable table(costs.size());
  for (std::uint32_t i = 0; i < costs.size(); ++i) {
    for (std::uint32_t j = 0; j < costs.size(); ++j) table.row(i)[j] = std::round(costs.cost(i, j) * kScale);
  }
  const assignment::Matching found = assignment::match_dense(table);
  double sum = 0;
  for (std::uint32_t i = 0; i < costs.size(); ++i) sum += costs.cost(i, found.target_of[i]);
  return sum;
}

TEST(Pairing, IsTheCheapestOfAllForEveryCost) {
  EXPECT_TRUE(rc::check([] {
    const auto size = *rc::gen::inRange<std::uint32_t>(1, 70);
    Rng rng(*rc::gen::arbitrary<std::uint64_t>());
    const auto kind = static_cast<CollectiveOptions::Pairing>(*rc::gen::inRange(0, 3));
    People people;
    for (std::uint32_t i = 0; i < size; ++i) {
      people.from.push_back({20 * rng.uniform(), 20 * rng.uniform()});
      people.to.push_back({30 + 5 * rng.uniform(), 40 * rng.uniform()});
      people.radius_m.push_back(0.25);
      people.speed_mps.push_back(0.7 + 0.7 * rng.uniform());
    }
    const PairCosts costs(people.task(), with(kind, rng.uniform()));
    const auto found = find_pairing(costs, nullptr);
    RC_ASSERT(found.has_value());
    RC_ASSERT(std::set(found->place_of.begin(), found->place_of.end()).size() == size);
    const double least = dense_least(costs);
    RC_ASSERT(std::abs(found->cost - least) <= 1e-4 * size);
    RC_ASSERT(found->gap <= 1e-9 * std::max(1.0, least));
  }));
}

TEST(Pairing, KeepsALatticeThatMovesAsItIs) {
  const Grid grid = *Grid::make(GridKind::square, 60, 12, 1);
  const People people = people_of(tests::block_of(grid, {0, 0}, 12, 12), tests::block_of(grid, {40, 0}, 12, 12));
  const auto found = find_pairing(PairCosts(people.task(), {}), nullptr);
  ASSERT_TRUE(found.has_value());
  for (std::uint32_t i = 0; i < people.from.size(); ++i) EXPECT_EQ(found->place_of[i], i);
}

/// A wall from the downstage edge up to row 8 of 10, in column 10.
std::vector<Cell> wall() {
  std::vector<Cell> out;
  for (int row = 0; row < 8; ++row) out.push_back({10, row});
  return out;
}

TEST(WalkField, IsNoLongerThanItsErrorAllows) {
  const tests::FloorTask floor = tests::task_on(21, 21, {}, {}, {}, 1);
  const WalkField field(*floor.ways);
  const Grid& grid = floor.ways->grid();
  const CellIndex goal = grid.index({10, 10});
  const std::vector<float> away = field.to(goal);
  EXPECT_NEAR(field.longest(), 1.0275, 1e-4);
  double worst = 0;
  for (int i = 0; i < grid.size(); ++i) {
    const double straight_m = distance(grid.centre(CellIndex::of(i)), grid.centre(goal));
    if (straight_m == 0) continue;
    EXPECT_GE(away[static_cast<std::size_t>(i)], straight_m - 1e-4);
    worst = std::max(worst, away[static_cast<std::size_t>(i)] / straight_m);
  }
  EXPECT_LE(worst, field.longest() + 1e-6);
  EXPECT_GT(worst, 1.02) << "the bound is a bound that is met";
}

TEST(WalkField, LeadsAroundAWallAndIsDrawnTaut) {
  const tests::FloorTask floor = tests::task_on(21, 10, wall(), {}, {}, 1);
  const WalkField field(*floor.ways);
  const Grid& grid = floor.ways->grid();
  const Point from = grid.centre(Cell{8, 0});
  const Point to = grid.centre(Cell{12, 0});
  const std::vector<Point> way = field.way(from, to);
  ASSERT_GE(way.size(), 3U);
  double long_m = 0;
  for (std::size_t k = 1; k < way.size(); ++k) {
    EXPECT_TRUE(floor.ways->straight(way[k - 1], way[k]));
    long_m += distance(way[k - 1], way[k]);
  }
  // Over the wall's end, 8 m up: at least 2 sqrt(7.5^2 + 1.5^2) + 1 m if the corner could be touched.
  EXPECT_GT(long_m, 2 * std::hypot(7.5, 1.5) + 1);
  EXPECT_NEAR(long_m, 2 * std::hypot(8, 1) + 2, 1e-9) << "over the cells at the wall's end";
  const double walked_m = field.to(grid.nearest(to))[grid.nearest(from).at()];
  EXPECT_LE(walked_m / field.longest(), long_m + 1e-6);
  EXPECT_GE(walked_m, long_m - 1e-4);
}

TEST(Pairing, CountsTheWayAroundAWall) {
  // Two behind the wall's end on the left, places on the right: straight, the lower person would take the lower place;
  // around the wall the sum of ways is the same for both, of squares it is not. Whoever is near the gap goes far.
  const tests::FloorTask floor = tests::task_on(21, 10, wall(), {}, {}, 1);
  const WalkField field(*floor.ways);
  const Grid& grid = floor.ways->grid();
  const People people = people_of({grid.centre(Cell{8, 0}), grid.centre(Cell{8, 9})},
                                  {grid.centre(Cell{12, 0}), grid.centre(Cell{8, 2})});
  const auto straight =
      find_pairing(PairCosts(people.task(), with(CollectiveOptions::Pairing::least_effort, 1)), nullptr);
  const auto around =
      find_pairing(PairCosts(people.task(&field), with(CollectiveOptions::Pairing::least_effort, 1)), nullptr);
  ASSERT_TRUE(straight && around);
  EXPECT_EQ(straight->place_of, (std::vector<std::uint32_t>{0, 1})) << "4 m through the wall";
  EXPECT_EQ(around->place_of, (std::vector<std::uint32_t>{1, 0})) << "who stands at the gap goes around";
}

TEST(Pairing, DoesNotExistThroughAClosedWall) {
  std::vector<Cell> closed;
  for (int row = 0; row < 10; ++row) closed.push_back({10, row});
  const tests::FloorTask floor = tests::task_on(21, 10, closed, {}, {}, 1);
  const WalkField field(*floor.ways);
  const Grid& grid = floor.ways->grid();
  const People people = people_of({grid.centre(Cell{8, 0}), grid.centre(Cell{8, 9})},
                                  {grid.centre(Cell{12, 0}), grid.centre(Cell{8, 2})});
  EXPECT_FALSE(find_pairing(PairCosts(people.task(&field), {}), nullptr).has_value());
  EXPECT_TRUE(field.way(people.from[0], people.to[0]).empty());
}

}  // namespace
}  // namespace footlight::planner::collective
