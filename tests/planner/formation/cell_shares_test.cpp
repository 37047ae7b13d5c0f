// SPDX-License-Identifier: Apache-2.0
#include "planner/formation/cell_shares.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"
#include "planner/formation/summed_area.hpp"
#include "tests/support/films.hpp"

namespace footlight::planner {
namespace {

constexpr GridKind kKinds[] = {GridKind::square, GridKind::hexagonal, GridKind::triangular};

TEST(CellShares, OfAMaskAreThoseOfASummedAreaTableOnEveryGridAtEveryScale) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    const int width = 1 + static_cast<int>(rng.below(200));
    const int height = 1 + static_cast<int>(rng.below(80));
    const std::uint64_t sparse = 1 + rng.below(20);
    const Mask mask =
        tests::mask_where(width, height, [&](int x, int) { return x % 70 < 60 && rng.below(sparse) == 0; });
    const Grid grid = *Grid::make(kKinds[rng.below(3)], 1 + static_cast<int>(rng.below(20)),
                                  1 + static_cast<int>(rng.below(12)), 0.5 + rng.uniform());
    // From many cells a pixel to many pixels a cell, on the frame, beside it and across its edges.
    const double scale = std::exp(6 * rng.uniform() - 2);
    const bool whole = rng.below(3) == 0;  // edges on pixels
    const StageToFrame map{whole ? std::ceil(scale) : scale,
                           0,
                           whole ? width / 2 : width * (2 * rng.uniform() - 0.5),
                           0,
                           whole ? -std::ceil(scale) : -scale,
                           whole ? height : height * (2 * rng.uniform() - 0.5)};
    const auto shares = cell_shares(mask, grid, map);
    const auto expected = cell_shares(SummedArea(mask), grid, map);
    RC_ASSERT(shares.size() == expected.size());
    for (std::size_t i = 0; i < shares.size(); ++i) RC_ASSERT(std::abs(shares[i] - expected[i]) < 1.1e-6);
  }));
}

TEST(CellShares, UpstageIsTheTopOfTheFrameForAMask) {
  const Grid grid = *Grid::make(GridKind::square, 2, 2, 1.0);
  const Mask top_left = tests::mask_where(20, 20, [](int x, int y) { return x < 10 && y < 10; });
  EXPECT_EQ(cell_shares(top_left, grid, {10, 0, 10, 0, -10, 20}), (std::vector<double>{0, 0, 1, 0}));
  EXPECT_EQ(picture_area(top_left), 100);
}

TEST(CellShares, OfAFullMaskAreExactlyOneAndOfABlankOneExactlyNothing) {
  const Grid grid = *Grid::make(GridKind::square, 7, 5, 1.0);
  const StageToFrame map{9.3, 0, 35, 0, -9.3, 48};
  const Mask full = tests::mask_where(70, 50, [](int, int) { return true; });
  EXPECT_EQ(cell_shares(full, grid, map)[grid.index({3, 2}).at()], 1.0);
  EXPECT_EQ(cell_shares(Mask(70, 50), grid, map), std::vector<double>(35, 0.0));
  EXPECT_EQ(cell_shares(Mask(), grid, map), std::vector<double>(35, 0.0));
}

}  // namespace
}  // namespace footlight::planner
