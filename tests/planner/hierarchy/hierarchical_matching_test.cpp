// SPDX-License-Identifier: Apache-2.0
#include "planner/hierarchy/hierarchical_matching.hpp"

#include <algorithm>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"
#include "planner/repair/closest_approach.hpp"

namespace footlight::planner {
namespace {

std::vector<CellIndex> some_cells(const Grid& grid, std::size_t count, Rng& rng) {
  std::vector<CellIndex> cells;
  for (int i = 0; i < grid.size(); ++i) cells.push_back(CellIndex::of(i));
  for (std::size_t i = 0; i < count; ++i) std::swap(cells[i], cells[i + rng.below(cells.size() - i)]);
  cells.resize(count);
  std::sort(cells.begin(), cells.end());
  return cells;
}

double squares(const Grid& grid, const std::vector<CellIndex>& from, const std::vector<CellIndex>& to,
               const std::vector<std::uint32_t>& target_of) {
  double sum = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    sum += squared_length(grid.centre(from[i]) - grid.centre(to[target_of[i]]));
  }
  return sum;
}

TEST(MatchHierarchically, IsABijectionWithoutConflictsForAnyNumberOfLayers) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    const Grid grid = *Grid::make(static_cast<GridKind>(rng.below(3)), 18, 15, 1.0);
    const std::size_t people = rng.below(120) + 1;
    const auto from = some_cells(grid, people, rng);
    const auto to = some_cells(grid, people, rng);
    PlannerOptions options;
    options.layers = static_cast<int>(rng.below(4)) + 1;
    options.region_size = static_cast<int>(rng.below(20)) + 1;
    const auto target_of = match_hierarchically(grid, from, to, options);
    std::vector<int> taken(people, 0);
    std::vector<Walk> walks;
    for (std::size_t i = 0; i < people; ++i) {
      ++taken[target_of[i]];
      walks.push_back({grid.centre(from[i]), grid.centre(to[target_of[i]])});
    }
    RC_ASSERT(std::all_of(taken.begin(), taken.end(), [](int n) { return n == 1; }));
    RC_ASSERT(near_pairs(walks, grid.clearance_bound_m() - 1e-9).empty());
  }));
}

TEST(MatchHierarchically, OneLayerIsTheGlobalOptimumAndMoreLayersCostNoLess) {
  Rng rng(5);
  const Grid grid = *Grid::make(GridKind::square, 20, 20, 1.0);
  const auto from = some_cells(grid, 150, rng);
  const auto to = some_cells(grid, 150, rng);
  PlannerOptions options;
  options.region_size = 12;
  options.layers = 1;
  const double flat = squares(grid, from, to, match_hierarchically(grid, from, to, options));
  PlannerOptions global = options;
  global.layers = 3;
  global.model = PlannerModel::flat;
  EXPECT_DOUBLE_EQ(squares(grid, from, to, pair_formations(grid, from, to, global)), flat);
  for (const int layers : {2, 3}) {
    options.layers = layers;
    EXPECT_GE(squares(grid, from, to, match_hierarchically(grid, from, to, options)), flat);
  }
}

TEST(MatchHierarchically, PartsOfThePictureThatOnlyMoveStayTogether) {
  const Grid grid = *Grid::make(GridKind::square, 40, 12, 1.0);
  std::vector<CellIndex> from;
  std::vector<CellIndex> to;
  for (int row = 0; row < 5; ++row) {
    for (const int column : {1, 2, 3, 4, 5, 30, 31, 32, 33, 34}) {
      from.push_back(grid.index({column, row}));
      to.push_back(grid.index({column + 2, row + 4}));
    }
  }
  const auto target_of = match_hierarchically(grid, from, to, {});
  for (std::size_t i = 0; i < from.size(); ++i) EXPECT_EQ(target_of[i], i);
}

TEST(MatchHierarchically, ALayerMoreDividesRegionsAgainIntoQuarters) {
  const Grid grid = *Grid::make(GridKind::square, 40, 30, 1.0);
  std::vector<CellIndex> from;
  std::vector<CellIndex> to;
  for (int i = 0; i < 240; ++i) {
    from.push_back(grid.index({i % 20, i / 20}));
    to.push_back(grid.index({15 + i % 12, 5 + i / 12}));
  }
  PlannerOptions once;
  once.region_size = 60;
  once.region_variance_m2 = 30;
  PlannerOptions twice = once;
  twice.layers = 3;
  twice.region_size = 240;
  twice.region_variance_m2 = 120;
  EXPECT_EQ(match_hierarchically(grid, from, to, twice), match_hierarchically(grid, from, to, once))
      << "everybody is one region first";
  twice.region_size = 60;
  EXPECT_NE(match_hierarchically(grid, from, to, twice), match_hierarchically(grid, from, to, once));
}

}  // namespace
}  // namespace footlight::planner
