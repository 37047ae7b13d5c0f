// SPDX-License-Identifier: Apache-2.0
#include "planner/formation/placement.hpp"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "planner/formation/summed_area.hpp"
#include "tests/support/films.hpp"

namespace footlight::planner {
namespace {

Stage stage_of(int columns, int rows, const std::vector<CellRange>& reserve = {}) {
  Stage stage;
  stage.grid = *Grid::make(GridKind::square, columns, rows, 1.0);
  for (int i = 0; i < stage.grid.size(); ++i) {
    const Cell cell = stage.grid.cell(CellIndex::of(i));
    for (const CellRange& range : reserve) {
      if (cell.column >= range.first.column && cell.column <= range.last.column && cell.row >= range.first.row &&
          cell.row <= range.last.row) {
        stage.reserve.push_back(CellIndex::of(i));
      }
    }
  }
  return stage;
}

CellFlags usable_on(const Stage& stage) {
  CellFlags usable(static_cast<std::size_t>(stage.grid.size()), 1);
  for (const CellIndex cell : stage.reserve) usable[cell.at()] = 0;
  return usable;
}

double filled(const Stage& stage, const CellFlags& usable, const Mask& mask, const Placement& placement) {
  const auto shares = cell_shares(SummedArea(mask), stage.grid, placement.map);
  double sum = 0;
  for (std::size_t i = 0; i < shares.size(); ++i) sum += usable[i] != 0 ? shares[i] : 0;
  return sum;
}

void expect_box(const Box& box, const Box& expected) {
  EXPECT_NEAR(box.x0, expected.x0, 1e-9);
  EXPECT_NEAR(box.y0, expected.y0, 1e-9);
  EXPECT_NEAR(box.x1, expected.x1, 1e-9);
  EXPECT_NEAR(box.y1, expected.y1, 1e-9);
}

TEST(PictureFloor, IsTheLargestRectangleWithoutReserve) {
  const Box box = picture_floor(stage_of(20, 10, {{{0, 0}, {2, 9}}, {{18, 0}, {19, 9}}}));
  expect_box(box, {-7, 0, 8, 10});
  expect_box(picture_floor(stage_of(4, 2)), {-2, 0, 2, 2});
}

TEST(PictureExtent, CoversAllMasksAndKnowsBlankOnes) {
  const Mask a = tests::mask_where(200, 50, [](int x, int y) { return x == 3 && y == 40; });
  const Mask b = tests::mask_where(200, 50, [](int x, int y) { return x == 150 && y == 2; });
  const Mask blank(200, 50);
  EXPECT_EQ(picture_extent({&a, &blank, &b}), (Box{3, 2, 151, 41}));
  EXPECT_FALSE(picture_extent({&blank}).has_value());
}

TEST(PlacePicture, AreaFillsAsManyCellsAsThereArePeopleInTheMiddleOfTheFloor) {
  const Stage stage = stage_of(60, 40, {{{0, 0}, {9, 39}}});
  const CellFlags usable = usable_on(stage);
  const Mask mask = tests::disc(320, 240, 90, 80, 50);
  const Placement placement = place_picture({&stage, &usable, Fit::area, &mask, *picture_extent({&mask}), 400});
  EXPECT_NEAR(filled(stage, usable, mask, placement), 400, 4);
  EXPECT_DOUBLE_EQ(placement.drawn_share, 1);
  // The disc's middle lies on the middle of the floor (x = 5, y = 20), but for the offset within half a cell.
  EXPECT_NEAR(placement.map[0] * 5 + placement.map[2], 90, 0.51 * placement.map[0]);
  EXPECT_NEAR(placement.map[4] * 20 + placement.map[5], 80, 0.51 * placement.map[0]);
}

TEST(PlacePicture, AreaThatDoesNotFitIsMadeSmallerAndSaysBy) {
  const Stage stage = stage_of(40, 10);
  const CellFlags usable = usable_on(stage);
  const Mask mask = tests::mask_where(100, 100, [](int, int) { return true; });
  const Placement placement = place_picture({&stage, &usable, Fit::area, &mask, *picture_extent({&mask}), 400});
  EXPECT_NEAR(placement.drawn_share, 0.5, 1e-9);
  EXPECT_NEAR(placement.map[0], 10, 1e-9);  // 100 pixels on 10 m
}

TEST(PlacePicture, BlockedCellsAreMadeUpForByALargerPicture) {
  Stage stage = stage_of(60, 60);
  CellFlags usable = usable_on(stage);
  for (int row = 26; row < 34; ++row) {
    for (int column = 26; column < 34; ++column) usable[stage.grid.index({column, row}).at()] = 0;
  }
  const Mask mask = tests::disc(200, 200, 100, 100, 80);
  const Placement placement = place_picture({&stage, &usable, Fit::area, &mask, *picture_extent({&mask}), 500});
  EXPECT_NEAR(filled(stage, usable, mask, placement), 500, 5);
}

TEST(PlacePicture, ContainShowsTheWholeFrameAndCoverTheWholeFloor) {
  const Stage stage = stage_of(40, 20);
  const CellFlags usable = usable_on(stage);
  const Mask mask = tests::mask_where(100, 100, [](int, int) { return true; });
  const Box whole{0, 0, 100, 100};
  EXPECT_DOUBLE_EQ(place_picture({&stage, &usable, Fit::contain, &mask, whole, 100}).map[0], 5);
  EXPECT_DOUBLE_EQ(place_picture({&stage, &usable, Fit::cover, &mask, whole, 100}).map[0], 2.5);
}

TEST(PlacePicture, ContainAndCoverMeanTheFloorThatTheReserveLeaves) {
  // 20 x 20 cells between the wings; the frame is twice as wide as high.
  const Stage stage = stage_of(40, 20, {{{0, 0}, {9, 19}}, {{30, 0}, {39, 19}}});
  const CellFlags usable = usable_on(stage);
  const Mask mask = tests::mask_where(200, 100, [](int, int) { return true; });
  const Box whole{0, 0, 200, 100};
  const Placement contain = place_picture({&stage, &usable, Fit::contain, &mask, whole, 200});
  const Placement cover = place_picture({&stage, &usable, Fit::cover, &mask, whole, 200});
  EXPECT_DOUBLE_EQ(contain.map[0], 10);  // 20 m for 200 pixels
  EXPECT_DOUBLE_EQ(cover.map[0], 5);     // 20 m for 100 pixels: what lies over the wings is not drawn
  EXPECT_NEAR(filled(stage, usable, mask, contain), 200, 10);
  EXPECT_NEAR(filled(stage, usable, mask, cover), 400, 20);
}

}  // namespace
}  // namespace footlight::planner
