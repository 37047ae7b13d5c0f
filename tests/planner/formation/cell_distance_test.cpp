// SPDX-License-Identifier: Apache-2.0
#include "planner/formation/cell_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"

namespace footlight::planner {
namespace {

TEST(CellDistance, IsTheLeastOverAllCellsOnEveryGrid) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    constexpr GridKind kKinds[] = {GridKind::square, GridKind::hexagonal, GridKind::triangular};
    const Grid grid = *Grid::make(kKinds[rng.below(3)], 1 + static_cast<int>(rng.below(15)),
                                  1 + static_cast<int>(rng.below(15)), 0.7);
    CellDistance away(grid);
    for (int round = 0; round < 2; ++round) {
      std::vector<CellIndex> to;
      const std::uint64_t one_in = 1 + rng.below(40);
      for (int i = 0; i < grid.size(); ++i) {
        if (rng.below(one_in) == 0) to.push_back(CellIndex::of(i));
      }
      away.set_to(to);
      for (int i = 0; i < grid.size(); ++i) {
        double least = std::numeric_limits<double>::infinity();
        for (const CellIndex cell : to) {
          least = std::min(least, distance(grid.centre(cell), grid.centre(CellIndex::of(i))));
        }
        RC_ASSERT(away.of(CellIndex::of(i)) == least);
      }
    }
  }));
}

TEST(GridLines, HoldEveryCellOnceInItsPlace) {
  for (const GridKind kind : {GridKind::square, GridKind::hexagonal, GridKind::triangular}) {
    const Grid grid = *Grid::make(kind, 5, 4, 2.0);
    std::vector<int> seen(static_cast<std::size_t>(grid.size()), 0);
    for (const GridLine& line : lines_of(grid)) {
      for (int n = 0; n < line.count; ++n) {
        ++seen[line.cell(n).at()];
        EXPECT_NEAR(grid.centre(line.cell(n)).x, line.x_m + n * line.step_m, 1e-12);
        EXPECT_NEAR(grid.centre(line.cell(n)).y, line.y_m, 1e-12);
      }
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), grid.size());
  }
}

}  // namespace
}  // namespace footlight::planner
