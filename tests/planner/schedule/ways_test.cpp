// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/ways.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace footlight::planner {
namespace {

Stage stage_with(GridKind kind, const std::vector<Cell>& blocked) {
  Stage stage;
  stage.grid = *Grid::make(kind, 11, 11, 1.0);
  for (const Cell cell : blocked) stage.blocked.push_back(stage.grid.index(cell));
  return stage;
}

TEST(Ways, WalkKeepsHalfTheClearanceFromABlockedSquare) {
  const Stage stage = stage_with(GridKind::square, {{5, 5}});
  const Ways ways(stage, 0.25);
  const Point middle = stage.grid.centre(Cell{5, 5});
  EXPECT_FALSE(ways.straight(middle + Point{-3, 0.7}, middle + Point{3, 0.7}));   // 0.2 m from its edge
  EXPECT_TRUE(ways.straight(middle + Point{-3, 0.75}, middle + Point{3, 0.75}));  // 0.25 m
  EXPECT_FALSE(ways.straight(middle + Point{0, -4}, middle + Point{0, 4}));
  EXPECT_TRUE(ways.straight(middle + Point{-4, 1}, middle + Point{4, 1}));
}

TEST(Ways, OutlinesCountOnHexagonsAndTriangles) {
  const Stage hexagons = stage_with(GridKind::hexagonal, {{5, 5}});
  const Point flat = hexagons.grid.centre(Cell{5, 5}) + Point{0.5 + 0.25, 0};  // the flat side looks to stage left
  EXPECT_TRUE(Ways(hexagons, 0.25).straight(flat + Point{0, -0.2}, flat + Point{0, 0.2}));
  EXPECT_FALSE(Ways(hexagons, 0.26).straight(flat + Point{0, -0.2}, flat + Point{0, 0.2}));
  const Stage triangles = stage_with(GridKind::triangular, {{4, 4}});
  const Point tip = triangles.grid.centre(Cell{4, 4}) + Point{0, 1.0};
  EXPECT_FALSE(Ways(triangles, 0.25).straight(tip + Point{-1, 0.2}, tip + Point{1, 0.2}));
  EXPECT_TRUE(Ways(triangles, 0.25).straight(tip + Point{-1, 0.26}, tip + Point{1, 0.26}));
}

TEST(Ways, NobodyStandsOnOrTooNearToABlockedCell) {
  const Stage stage = stage_with(GridKind::square, {{5, 5}});
  EXPECT_FALSE(Ways(stage, 0.25).can_stand(stage.grid.index({5, 5})));
  EXPECT_TRUE(Ways(stage, 0.5).can_stand(stage.grid.index({4, 5})));
  EXPECT_FALSE(Ways(stage, 0.6).can_stand(stage.grid.index({4, 5})));
}

TEST(Ways, GoesStraightWhereNothingIsInTheWay) {
  const Ways ways(stage_with(GridKind::square, {}), 0.25);
  const Ways::Step step = ways.toward({-4, 1}, {4, 7}, 2.5);
  EXPECT_DOUBLE_EQ(step.length_m, 10);
  EXPECT_NEAR(distance(step.at, {-2, 2.5}), 0, 1e-12);
}

TEST(Ways, GoesAroundAWallByAShortWay) {
  const Stage stage = stage_with(GridKind::square, {{5, 0}, {5, 1}, {5, 2}, {5, 3}, {5, 4}, {5, 5}, {5, 6}, {5, 7}});
  const Ways ways(stage, 0.25);
  const Point from = stage.grid.centre(Cell{2, 2});
  const Point to = stage.grid.centre(Cell{8, 2});
  const double length_m = ways.toward(from, to, 0).length_m;
  EXPECT_GT(length_m, 2 * std::hypot(2.5, 5.5));
  EXPECT_LT(length_m, 14.7);  // over the wall's end, drawn taut
  Point last = from;
  for (double walked = 0; walked < length_m + 0.2; walked += 0.1) {
    const Point here = ways.toward(from, to, walked).at;
    EXPECT_LT(distance(last, here), 0.1 + 1e-9);
    EXPECT_TRUE(ways.straight(here, here));
    last = here;
  }
  EXPECT_EQ(last, to);
}

TEST(Ways, WhoIsWalledInStays) {
  std::vector<Cell> wall;
  for (int row = 0; row < 11; ++row) wall.push_back({5, row});
  const Ways ways(stage_with(GridKind::square, wall), 0.25);
  EXPECT_TRUE(std::isinf(ways.toward({-3, 5.5}, {3, 5.5}, 2).length_m));
  EXPECT_EQ(ways.toward({-3, 5.5}, {3, 5.5}, 2).at, (Point{-3, 5.5}));
}

}  // namespace
}  // namespace footlight::planner
