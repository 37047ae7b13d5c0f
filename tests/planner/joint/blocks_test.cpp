// SPDX-License-Identifier: Apache-2.0
#include "planner/joint/blocks.hpp"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include "tests/planner/small_show.hpp"

namespace footlight::planner {
namespace {

using test::cells_in;

Stage stage_of(GridKind kind, int columns, int rows) {
  Stage stage;
  stage.grid = *Grid::make(kind, columns, rows, 1.5);
  return stage;
}

CellFlags flags(const Stage& stage, const std::vector<CellIndex>& cells) {
  CellFlags out(static_cast<std::size_t>(stage.grid.size()), 0);
  for (const CellIndex cell : cells) out[cell.at()] = 1;
  return out;
}

std::vector<std::uint32_t> reached(const Reach& reach, std::uint32_t from) {
  return {reach.to.begin() + reach.first[from], reach.to.begin() + reach.first[from + 1]};
}

TEST(Blocks, OfOneCellAreTheCells) {
  const Stage stage = stage_of(GridKind::hexagonal, 7, 5);
  const Ways ways(stage, 0.25);
  Blocks blocks(ways, flags(stage, {}), 1);
  EXPECT_EQ(blocks.size(), 35U);
  EXPECT_EQ(blocks.cells_each(), 1.0);
  const Reach reach = blocks.reach(1.6);
  for (std::uint32_t c = 0; c < 35; ++c) {
    auto expected = stage.grid.neighbours(CellIndex(c));
    expected.emplace_back(c);
    std::sort(expected.begin(), expected.end());
    const auto found = reached(reach, c);
    EXPECT_TRUE(std::equal(found.begin(), found.end(), expected.begin(), expected.end(),
                           [](std::uint32_t a, CellIndex b) { return a == b.value(); }));
  }
}

TEST(Blocks, OfFourCellsJoinTheirNeighboursWhateverTheReach) {
  const Stage stage = stage_of(GridKind::square, 8, 6);
  const Ways ways(stage, 0.25);
  Blocks blocks(ways, flags(stage, {}), 2);
  EXPECT_EQ(blocks.size(), 12U);
  EXPECT_EQ(blocks.cells_each(), 4.0);
  EXPECT_EQ(blocks.block_of(0), 0U);
  EXPECT_EQ(blocks.block_of(9), 0U);
  EXPECT_EQ(blocks.block_of(10), 1U);
  EXPECT_EQ(reached(blocks.reach(0.1), 5), (std::vector<std::uint32_t>{1, 4, 5, 6, 9}));
  EXPECT_EQ(blocks.squares(), (std::vector<double>{0, 4}));
}

TEST(Blocks, AreUsableWhereMostOfTheirCellsAreAndWaitWhereMostOfThoseDo) {
  Stage stage = stage_of(GridKind::square, 8, 4);
  stage.blocked = cells_in(stage.grid, "C1:D2");
  const Ways ways(stage, 0.25);
  Blocks blocks(ways, flags(stage, cells_in(stage.grid, "A1:A4")), 2);
  const Reach reach = blocks.reach(3.0);
  EXPECT_TRUE(reached(reach, 1).empty());
  const auto from_first = reached(reach, 0);
  EXPECT_EQ(std::count(from_first.begin(), from_first.end(), 1U), 0);
  EXPECT_FALSE(blocks.waits(0));
  Blocks wings(ways, flags(stage, cells_in(stage.grid, "A1:B4")), 2);
  EXPECT_TRUE(wings.waits(0));
  EXPECT_FALSE(wings.waits(2));
}

TEST(Blocks, KeepSumsWhenTheyTakeMeans) {
  for (const GridKind kind : {GridKind::square, GridKind::hexagonal, GridKind::triangular}) {
    const Stage stage = stage_of(kind, 9, 7);
    const Ways ways(stage, 0.25);
    const Blocks blocks(ways, flags(stage, {}), 2);
    std::vector<double> values(63);
    std::iota(values.begin(), values.end(), 1.0);
    const auto means = blocks.mean(values);
    EXPECT_NEAR(std::accumulate(means.begin(), means.end(), 0.0) * blocks.cells_each(),
                std::accumulate(values.begin(), values.end(), 0.0), 1e-9);
  }
}

TEST(Blocks, GiveCellsValuesBetweenTheirOwn) {
  const Stage stage = stage_of(GridKind::square, 4, 2);
  const Ways ways(stage, 0.25);
  const Blocks blocks(ways, flags(stage, {}), 2);
  EXPECT_EQ(blocks.at_cells({0, 8}), (std::vector<float>{0, 2, 6, 8, 0, 2, 6, 8}));
}

}  // namespace
}  // namespace footlight::planner
