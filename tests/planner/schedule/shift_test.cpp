// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/shift.hpp"

#include <algorithm>
#include <memory>

#include <gtest/gtest.h>

namespace footlight::planner {
namespace {

/// A wall across the middle column, open at the top.
Stage walled_stage() {
  Stage stage;
  stage.grid = *Grid::make(GridKind::square, 9, 6, 1.0);
  for (int row = 0; row < 5; ++row) stage.blocked.push_back(stage.grid.index({4, row}));
  return stage;
}

std::vector<CellIndex> column(const Grid& grid, int at) {
  std::vector<CellIndex> cells;
  for (int row = 0; row < grid.rows(); ++row) cells.push_back(grid.index({at, row}));
  return cells;
}

TEST(Shift, EverybodyGoesThroughTheOneGapCellByCell) {
  const Stage stage = walled_stage();
  const Ways ways(stage, 0.25);
  const auto from = column(stage.grid, 1);
  const auto to = column(stage.grid, 7);
  const auto places = shift({&ways, from, to, 40});
  ASSERT_TRUE(places);
  EXPECT_EQ(places->front(), from);
  EXPECT_TRUE(std::is_permutation(places->back().begin(), places->back().end(), to.begin()));
  for (std::size_t step = 1; step < places->size(); ++step) {
    auto here = (*places)[step];
    for (std::size_t i = 0; i < here.size(); ++i) {
      EXPECT_LE(distance(stage.grid.centre(here[i]), stage.grid.centre((*places)[step - 1][i])), 1.0 + 1e-9);
      EXPECT_TRUE(ways.can_stand(here[i]));
    }
    std::sort(here.begin(), here.end());
    EXPECT_EQ(std::adjacent_find(here.begin(), here.end()), here.end());
  }
}

TEST(Shift, WhatTakesTooManyStepsOrHasNoWayIsNotFound) {
  Stage stage = walled_stage();
  // The last of six passes the gap five steps after the first.
  EXPECT_FALSE(shift({std::make_unique<Ways>(stage, 0.25).get(), column(stage.grid, 1), column(stage.grid, 7), 10}));
  stage.blocked.push_back(stage.grid.index({4, 5}));
  const Ways closed(stage, 0.25);
  EXPECT_FALSE(shift({&closed, column(stage.grid, 1), column(stage.grid, 7), 500}));
}

}  // namespace
}  // namespace footlight::planner
