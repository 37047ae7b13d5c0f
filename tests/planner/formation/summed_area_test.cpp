// SPDX-License-Identifier: Apache-2.0
#include "planner/formation/summed_area.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"
#include "tests/support/films.hpp"

namespace footlight::planner {
namespace {

TEST(SummedArea, AreaOfAnyRectangleIsTheSumOfItsPixels) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    const int width = static_cast<int>(rng.below(90)) + 1;
    const int height = static_cast<int>(rng.below(20)) + 1;
    const Mask mask = tests::mask_where(width, height, [&](int, int) { return rng.below(2) == 0; });
    const int x0 = static_cast<int>(rng.below(static_cast<std::uint64_t>(width)));
    const int y0 = static_cast<int>(rng.below(static_cast<std::uint64_t>(height)));
    const int x1 = x0 + static_cast<int>(rng.below(static_cast<std::uint64_t>(width - x0 + 1)));
    const int y1 = y0 + static_cast<int>(rng.below(static_cast<std::uint64_t>(height - y0 + 1)));
    int expected = 0;
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) expected += mask.at(x, y) ? 1 : 0;
    }
    RC_ASSERT(SummedArea(mask).area(x0, y0, x1, y1) == expected);
  }));
}

TEST(SummedArea, CountsPartsOfPixelsAndNothingOutside) {
  const SummedArea full(tests::mask_where(4, 2, [](int, int) { return true; }));
  EXPECT_DOUBLE_EQ(full.area(0.25, 0.5, 1.75, 1.0), 0.75);
  EXPECT_DOUBLE_EQ(full.area(-3, -3, 0.5, 9), 1.0);
  EXPECT_DOUBLE_EQ(full.area(5, 0, 9, 2), 0.0);
  EXPECT_EQ(full.total(), 8);
}

TEST(CellShares, UpstageIsTheTopOfTheFrame) {
  const Grid grid = *Grid::make(GridKind::square, 2, 2, 1.0);
  const SummedArea top_left(tests::mask_where(20, 20, [](int x, int y) { return x < 10 && y < 10; }));
  const auto shares = cell_shares(top_left, grid, {10, 0, 10, 0, -10, 20});
  EXPECT_EQ(shares, (std::vector<double>{0, 0, 1, 0}));  // A2: stage right, upstage
}

TEST(CellShares, JudgedSquareHasOneCellsAreaOnEveryGrid) {
  for (const GridKind kind : {GridKind::square, GridKind::hexagonal, GridKind::triangular}) {
    const Grid grid = *Grid::make(kind, 5, 5, 2.0);
    const SummedArea half(tests::mask_where(400, 400, [](int x, int) { return x < 200; }));
    const Point centre = grid.centre(Cell{2, 2});
    const auto shares = cell_shares(half, grid, {10, 0, 200 - 10 * centre.x, 0, -10, 200 + 10 * centre.y});
    EXPECT_NEAR(shares[grid.index({2, 2}).at()], 0.5, 1e-6);
  }
}

}  // namespace
}  // namespace footlight::planner
