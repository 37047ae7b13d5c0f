// SPDX-License-Identifier: Apache-2.0
#include "planner/formation/formation.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"

namespace footlight::planner {
namespace {

struct Floor {
  explicit Floor(GridKind kind = GridKind::square, int columns = 16, int rows = 16)
      : grid(*Grid::make(kind, columns, rows, 1.0)),
        shares(static_cast<std::size_t>(grid.size()), 0.0),
        usable(shares.size(), 1),
        ranks(even_ranks(grid)) {}
  [[nodiscard]] Drawing drawn(int most, int least, std::span<const CellIndex> when_blank = {}) const {
    return draw({&grid, &shares, &usable, &ranks, most, least, when_blank});
  }
  Grid grid;
  std::vector<double> shares;
  CellFlags usable;
  std::vector<std::uint32_t> ranks;
};

TEST(Draw, TakesAsManyCellsAsThePicturesAreaFills) {
  Floor floor;
  for (std::size_t i = 0; i < 10; ++i) floor.shares[i] = 0.9;
  for (std::size_t i = 10; i < 20; ++i) floor.shares[i] = 0.1;
  const Drawing drawing = floor.drawn(100, 0);
  ASSERT_EQ(drawing.cells.size(), 10U);
  EXPECT_EQ(drawing.cells.back(), CellIndex(9));
  EXPECT_EQ(drawing.touched, 20);
  EXPECT_EQ(drawing.full, 10);
}

TEST(Draw, ThinsAFullPictureEvenlyAndNeverInScanOrder) {
  Floor floor;
  std::fill(floor.shares.begin(), floor.shares.end(), 1.0);
  const Drawing drawing = floor.drawn(64, 64);
  ASSERT_EQ(drawing.cells.size(), 64U);
  int quarter[4] = {0, 0, 0, 0};
  for (const CellIndex cell : drawing.cells) {
    const Cell at = floor.grid.cell(cell);
    ++quarter[(at.column >= 8 ? 1 : 0) + (at.row >= 8 ? 2 : 0)];
  }
  for (const int people : quarter) EXPECT_EQ(people, 16);
}

TEST(Draw, ThinnerPicturesAreContainedInFullerOnes) {
  Floor floor;
  std::fill(floor.shares.begin(), floor.shares.end(), 1.0);
  const Drawing fewer = floor.drawn(50, 50);
  const Drawing more = floor.drawn(51, 51);
  EXPECT_TRUE(std::includes(more.cells.begin(), more.cells.end(), fewer.cells.begin(), fewer.cells.end()));
}

TEST(Draw, WidensThePictureByTheNearestCellsWhenTheReserveHasNoRoom) {
  Floor floor;
  floor.shares[floor.grid.index({8, 8}).at()] = 1;
  const Drawing drawing = floor.drawn(9, 9);
  ASSERT_EQ(drawing.cells.size(), 9U);
  EXPECT_EQ(drawing.in_picture, 1);
  for (const CellIndex cell : drawing.cells) {
    EXPECT_LT(distance(floor.grid.centre(cell), floor.grid.centre(Cell{8, 8})), 1.5);
  }
}

TEST(Draw, BlankPictureDrawsNobodyOrWidensWhatItIsGiven) {
  Floor floor;
  EXPECT_TRUE(floor.drawn(10, 0).cells.empty());
  const std::vector<CellIndex> kept{floor.grid.index({3, 3})};
  EXPECT_EQ(floor.drawn(10, 1, kept).cells, kept);
}

TEST(Draw, ExactlyTheNumberAskedForAndNeverAnUnusableCell) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    Floor floor(static_cast<GridKind>(rng.below(3)), 12, 9);
    int usable = 0;
    for (std::size_t i = 0; i < floor.shares.size(); ++i) {
      floor.shares[i] = rng.below(3) == 0 ? rng.uniform() : static_cast<double>(rng.below(2));
      floor.usable[i] = rng.below(5) == 0 ? 0 : 1;
      usable += floor.usable[i];
    }
    const int people = static_cast<int>(rng.below(static_cast<std::uint64_t>(usable))) + 1;
    const Drawing drawing = floor.drawn(people, people);
    RC_ASSERT(static_cast<int>(drawing.cells.size()) == people);
    RC_ASSERT(std::set<CellIndex>(drawing.cells.begin(), drawing.cells.end()).size() == drawing.cells.size());
    double least_taken = 1;
    for (const CellIndex cell : drawing.cells) {
      RC_ASSERT(floor.usable[cell.at()] == 1);
      least_taken = std::min(least_taken, floor.shares[cell.at()]);
    }
    for (std::size_t i = 0; i < floor.shares.size(); ++i) {
      const bool taken = std::binary_search(drawing.cells.begin(), drawing.cells.end(), CellIndex::of(i));
      if (!taken && floor.usable[i] != 0) RC_ASSERT(floor.shares[i] <= least_taken);
    }
  }));
}

TEST(WaitingPlaces, ChangeByNoMoreCellsThanPeopleEnterOrLeave) {
  const Grid grid = *Grid::make(GridKind::square, 20, 6, 1.0);
  std::vector<CellIndex> reserve;
  for (int row = 0; row < 6; ++row) {
    for (int column : {0, 1, 2, 17, 18, 19}) reserve.push_back(grid.index({column, row}));
  }
  std::sort(reserve.begin(), reserve.end());
  std::vector<Drawing> drawings(4);
  const std::vector<int> sizes{0, 5, 12, 7};
  for (std::size_t k = 0; k < drawings.size(); ++k) {
    for (int i = 0; i < sizes[k]; ++i) drawings[k].cells.push_back(grid.index({5 + i % 4, i / 4}));
  }
  const auto waiting = waiting_places({&grid, &reserve, &drawings, 20});
  for (std::size_t k = 0; k < waiting.size(); ++k) {
    EXPECT_EQ(waiting[k].size() + drawings[k].cells.size(), 20U);
    if (k == 0) continue;
    std::vector<CellIndex> changed;
    std::set_symmetric_difference(waiting[k - 1].begin(), waiting[k - 1].end(), waiting[k].begin(), waiting[k].end(),
                                  std::back_inserter(changed));
    EXPECT_EQ(changed.size(), static_cast<std::size_t>(std::abs(sizes[k] - sizes[k - 1])));
    // The picture stands at stage right, so that side's people go in.
    for (const CellIndex cell : changed) EXPECT_LT(grid.cell(cell).column, 3);
  }
}

}  // namespace
}  // namespace footlight::planner
