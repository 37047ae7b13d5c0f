// SPDX-License-Identifier: Apache-2.0
#include "planner/formation/seats.hpp"

#include <cmath>
#include <optional>
#include <set>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"
#include "planner/assignment/assignment.hpp"

namespace footlight::planner {
namespace {

Grid grid_of(int columns, int rows) { return *Grid::make(GridKind::square, columns, rows, 1.0); }
CellFlags all_of(const Grid& grid) { return CellFlags(static_cast<std::size_t>(grid.size()), 1); }

TEST(Seats, ArePointsOwnCellsWhereTheyAreDistinct) {
  const Grid grid = grid_of(9, 9);
  const CellFlags usable = all_of(grid);
  Seats seats(grid, usable, 3);
  ASSERT_TRUE(seats.add({{-4.2, 0.7}, {0.3, 4.4}, {4, 8.6}}));
  EXPECT_EQ(grid.name(seats.cells()[0]), "A1");
  EXPECT_EQ(grid.name(seats.cells()[1]), "E5");
  EXPECT_EQ(grid.name(seats.cells()[2]), "I9");
}

/// The least sum of squares with nobody farther from the point than the reach; nothing when there is no such seating.
std::optional<double> least_cost(const Grid& grid, const std::vector<Point>& points, double reach) {
  std::vector<Arc> arcs;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    for (std::uint32_t j = 0; j < points.size(); ++j) {
      const double square = squared_length(grid.centre(CellIndex(j)) - points[i]);
      if (square <= reach * reach) arcs.push_back({i, j, square});
    }
  }
  const auto best = assign_sparse(static_cast<std::uint32_t>(points.size()), arcs);
  return best ? std::optional(best->cost) : std::nullopt;
}

TEST(Seats, HaveTheLeastSumOfSquares) {
  EXPECT_TRUE(rc::check([] {
    const Grid grid = grid_of(5, 4);
    const CellFlags usable = all_of(grid);
    Rng rng(*rc::gen::arbitrary<std::uint64_t>());
    std::vector<Point> points;
    for (int i = 0; i < 20; ++i) points.push_back({5 * rng.uniform() - 2.5, 4 * rng.uniform()});
    Seats seats(grid, usable, 20);
    RC_ASSERT(seats.add(points));
    const auto cells = seats.cells();
    double cost = 0;
    for (std::size_t i = 0; i < 20; ++i) cost += squared_length(grid.centre(cells[i]) - points[i]);
    auto best = least_cost(grid, points, 1.6);
    if (!best) best = least_cost(grid, points, 3.2);
    if (!best) best = least_cost(grid, points, 10);
    RC_ASSERT(std::abs(cost - *best) < 1e-9);
  }));
}

TEST(Seats, OfSeveralDrawingsShareNoCell) {
  EXPECT_TRUE(rc::check([] {
    const Grid grid = grid_of(8, 8);
    const CellFlags usable = all_of(grid);
    Rng rng(*rc::gen::arbitrary<std::uint64_t>());
    Seats seats(grid, usable, 40);
    for (int part = 0; part < 4; ++part) {
      std::vector<Point> points;
      for (int i = 0; i < 10; ++i) points.push_back({6 * rng.uniform() - 3, 6 * rng.uniform() + 1});
      RC_ASSERT(seats.add(points));
    }
    const auto cells = seats.cells();
    RC_ASSERT(std::set<CellIndex>(cells.begin(), cells.end()).size() == 40U);
  }));
}

TEST(Seats, RefuseWhatHasNoRoomBesideTheOthers) {
  const Grid grid = grid_of(2, 2);
  const CellFlags usable = all_of(grid);
  Seats seats(grid, usable, 5);
  ASSERT_TRUE(seats.add({{0, 1}, {0, 1}, {0, 1}}));
  EXPECT_FALSE(seats.add({{0, 1}, {0, 1}}));
}

TEST(Seats, TakeOnlyCellsThatTheDrawingMayHave) {
  const Grid grid = grid_of(4, 1);
  const CellFlags usable = all_of(grid);
  Seats seats(grid, usable, 1);
  ASSERT_TRUE(seats.add({{-1.5, 0.5}}, {0, 0, 0, 1}));
  EXPECT_EQ(grid.name(seats.cells()[0]), "D1");
}

}  // namespace
}  // namespace footlight::planner
