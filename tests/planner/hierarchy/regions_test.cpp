// SPDX-License-Identifier: Apache-2.0
#include "planner/hierarchy/regions.hpp"

#include <algorithm>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"

namespace footlight::planner {
namespace {

std::vector<CellIndex> block(const Grid& grid, int columns, int rows) {
  std::vector<CellIndex> cells;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) cells.push_back(grid.index({column, row}));
  }
  return cells;
}

TEST(GrowRegions, FirstSeedIsOnTheBoundary) {
  const Grid grid = *Grid::make(GridKind::square, 9, 9, 1.0);
  const auto regions = grow_regions(grid, block(grid, 9, 9), {10, 100});
  EXPECT_EQ(regions.front().members.front(), 0U);  // the corner: two neighbours
}

TEST(GrowRegions, PartsThatDoNotTouchAreDifferentRegions) {
  const Grid grid = *Grid::make(GridKind::square, 9, 3, 1.0);
  const std::vector<CellIndex> cells{grid.index({0, 0}), grid.index({1, 0}), grid.index({5, 0})};
  EXPECT_EQ(grow_regions(grid, cells, {60, 30}).size(), 2U);
}

TEST(GrowRegions, VarianceKeepsRegionsCompact) {
  const Grid grid = *Grid::make(GridKind::square, 40, 1, 1.0);
  for (const Region& region : grow_regions(grid, block(grid, 40, 1), {60, 2.0})) {
    EXPECT_LE(region.members.size(), 5U);  // five in a row have variance 2
  }
}

TEST(GrowRegions, EverybodyIsInOneRegionWithinTheLimits) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    const Grid grid = *Grid::make(static_cast<GridKind>(rng.below(3)), 14, 12, 1.0);
    std::vector<CellIndex> cells;
    for (int i = 0; i < grid.size(); ++i) {
      if (rng.below(3) != 0) cells.push_back(CellIndex::of(i));
    }
    const RegionLimits limits{static_cast<int>(rng.below(20)) + 1, 1 + 6 * rng.uniform()};
    std::vector<int> seen(cells.size(), 0);
    for (const Region& region : grow_regions(grid, cells, limits)) {
      RC_ASSERT(static_cast<int>(region.members.size()) <= limits.most_people);
      Point sum;
      for (const std::uint32_t member : region.members) {
        ++seen[member];
        sum = sum + grid.centre(cells[member]);
      }
      const double size = static_cast<double>(region.members.size());
      RC_ASSERT(distance((1 / size) * sum, region.anchor) < 1e-9);
      double squares = 0;
      for (const std::uint32_t member : region.members) {
        squares += squared_length(grid.centre(cells[member]) - region.anchor);
      }
      RC_ASSERT(squares / size <= limits.variance_m2 + 1e-9);
    }
    RC_ASSERT(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; }));
  }));
}

}  // namespace
}  // namespace footlight::planner
