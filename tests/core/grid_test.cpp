// SPDX-License-Identifier: Apache-2.0
#include "core/grid.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"

namespace footlight {
namespace {

using testing::ElementsAre;
constexpr double kSqrt3 = std::numbers::sqrt3;
constexpr GridKind kKinds[] = {GridKind::square, GridKind::hexagonal, GridKind::triangular};

Grid grid_of(GridKind kind, int columns, int rows, double pitch_m = 1.0) {
  return *Grid::make(kind, columns, rows, pitch_m);
}
Grid random_grid(Rng& rng) {
  return grid_of(kKinds[rng.below(3)], 1 + static_cast<int>(rng.below(12)), 1 + static_cast<int>(rng.below(12)),
                 0.2 + 2 * rng.uniform());
}
/// On the grid or up to a few pitches beside it.
Point random_point(const Grid& grid, Rng& rng) {
  return {(rng.uniform() - 0.5) * (grid.columns() + 4) * grid.pitch_m(),
          (rng.uniform() * (1.6 * grid.rows() + 4) - 2) * grid.pitch_m()};
}
void expect_point(Point found, Point expected) {
  EXPECT_NEAR(found.x, expected.x, 1e-12);
  EXPECT_NEAR(found.y, expected.y, 1e-12);
}

TEST(Grid, PutsSquareCentresHalfAPitchFromTheDownstageEdgeAroundTheCentreLine) {
  const Grid grid = grid_of(GridKind::square, 4, 3, 2.0);
  expect_point(grid.centre(Cell{0, 0}), {-3, 1});
  expect_point(grid.centre(Cell{3, 2}), {3, 5});
  expect_point(grid_of(GridKind::square, 5, 1).centre(Cell{2, 0}), {0, 0.5});
}

TEST(Grid, ShiftsOddHexagonalRowsByHalfAPitch) {
  const Grid grid = grid_of(GridKind::hexagonal, 3, 3, 2.0);
  expect_point(grid.centre(Cell{1, 0}), {0, 2 / kSqrt3});
  expect_point(grid.centre(Cell{1, 1}), {1, 2 / kSqrt3 + kSqrt3});
  expect_point(grid.centre(Cell{1, 2}), {0, 2 / kSqrt3 + 2 * kSqrt3});
}

TEST(Grid, PointsTheFirstTriangleUpstage) {
  const Grid grid = grid_of(GridKind::triangular, 3, 2, 2.0);
  expect_point(grid.centre(Cell{0, 0}), {-kSqrt3, 1});
  expect_point(grid.centre(Cell{1, 0}), {0, 2});
  expect_point(grid.centre(Cell{0, 1}), {-kSqrt3, 5});
  expect_point(grid.centre(Cell{1, 1}), {0, 4});
}

TEST(Grid, HasCellsThatStandOnTheDownstageEdge) {
  for (const GridKind kind : kKinds) {
    const Grid grid = grid_of(kind, 4, 1, 1.5);
    double lowest = 1e9;
    for (int i = 0; i < grid.size(); ++i) {
      for (const Point corner : grid.outline(CellIndex::of(i))) lowest = std::min(lowest, corner.y);
    }
    EXPECT_NEAR(lowest, 0, 1e-12) << to_text(kind);
  }
}

TEST(Grid, RefusesSizesAndPitchesOutOfRangeWithAMessage) {
  const auto message = [](int columns, int rows, double pitch_m) {
    return Grid::make(GridKind::square, columns, rows, pitch_m).error();
  };
  EXPECT_EQ(message(0, 5, 1), input_error("a grid has 1 to 4096 columns"));
  EXPECT_EQ(message(4097, 5, 1), input_error("a grid has 1 to 4096 columns"));
  EXPECT_EQ(message(5, 0, 1), input_error("a grid has 1 to 4096 rows"));
  EXPECT_EQ(message(5, 4097, 1), input_error("a grid has 1 to 4096 rows"));
  EXPECT_EQ(message(4000, 1001, 1), input_error("a grid has at most 4,000,000 cells"));
  EXPECT_EQ(message(5, 5, 0), input_error("the pitch lies above 0 m and is at most 100 m"));
  EXPECT_EQ(message(5, 5, 100.1), input_error("the pitch lies above 0 m and is at most 100 m"));
  EXPECT_EQ(message(5, 5, std::nan("")), input_error("the pitch lies above 0 m and is at most 100 m"));
  EXPECT_TRUE(Grid::make(GridKind::square, 4000, 1000, 100).has_value());
  EXPECT_TRUE(Grid::make(GridKind::square, 1, 4096, 1e-3).has_value());
}

TEST(Grid, CountsCellsRowByRowFromDownstageStageRight) {
  const Grid grid = grid_of(GridKind::square, 4, 3);
  EXPECT_EQ(grid.index({0, 0}), CellIndex::of(0));
  EXPECT_EQ(grid.index({3, 0}), CellIndex::of(3));
  EXPECT_EQ(grid.index({0, 1}), CellIndex::of(4));
  EXPECT_EQ(grid.cell(CellIndex::of(11)), (Cell{3, 2}));
  EXPECT_EQ(grid.name(CellIndex::of(11)), "D3");
  EXPECT_TRUE(grid.contains({3, 2}));
  EXPECT_FALSE(grid.contains({4, 2}));
  EXPECT_FALSE(grid.contains({3, 3}));
  EXPECT_FALSE(grid.contains({-1, 0}));
}

TEST(GridDeathTest, AnIndexOfACellOffTheGridIsAProgrammerError) {
  EXPECT_DEATH(static_cast<void>(grid_of(GridKind::square, 4, 3).index({4, 0})), "contains\\(cell\\)");
}

std::vector<std::string> neighbour_names(GridKind kind, const char* name) {
  const Grid grid = grid_of(kind, 4, 4);
  std::vector<std::string> out;
  for (const CellIndex index : grid.neighbours(grid.index(*parse_cell(name)))) out.push_back(grid.name(index));
  return out;
}

TEST(Grid, NeighboursOfASquareAreFour) {
  EXPECT_THAT(neighbour_names(GridKind::square, "B2"), ElementsAre("B1", "A2", "C2", "B3"));
  EXPECT_THAT(neighbour_names(GridKind::square, "A1"), ElementsAre("B1", "A2"));
  EXPECT_THAT(neighbour_names(GridKind::square, "D4"), ElementsAre("D3", "C4"));
}

TEST(Grid, NeighboursOfAHexagonAreSix) {
  EXPECT_THAT(neighbour_names(GridKind::hexagonal, "B2"), ElementsAre("B1", "C1", "A2", "C2", "B3", "C3"));
  EXPECT_THAT(neighbour_names(GridKind::hexagonal, "B3"), ElementsAre("A2", "B2", "A3", "C3", "A4", "B4"));
  EXPECT_THAT(neighbour_names(GridKind::hexagonal, "A1"), ElementsAre("B1", "A2"));
}

TEST(Grid, NeighboursOfATriangleAreThree) {
  // B2 points upstage: its base is shared with the cell below; B3 points downstage.
  EXPECT_THAT(neighbour_names(GridKind::triangular, "B2"), ElementsAre("B1", "A2", "C2"));
  EXPECT_THAT(neighbour_names(GridKind::triangular, "B3"), ElementsAre("A3", "C3", "B4"));
  EXPECT_THAT(neighbour_names(GridKind::triangular, "A1"), ElementsAre("B1"));
}

TEST(GridProperty, NeighboursAreOnePitchAwayAndMutual) {
  const bool held = rc::check([](std::uint64_t seed) {
    Rng rng(seed);
    const Grid grid = random_grid(rng);
    const auto index = CellIndex::of(rng.below(static_cast<std::uint64_t>(grid.size())));
    for (const CellIndex other : grid.neighbours(index)) {
      RC_ASSERT(std::abs(distance(grid.centre(index), grid.centre(other)) - grid.pitch_m()) < 1e-9);
      const std::vector<CellIndex> back = grid.neighbours(other);
      RC_ASSERT(std::find(back.begin(), back.end(), index) != back.end());
    }
  });
  EXPECT_TRUE(held);
}

TEST(GridProperty, NoTwoCentresAreNearerThanAPitch) {
  for (const GridKind kind : kKinds) {
    const Grid grid = grid_of(kind, 7, 6, 1.3);
    for (int i = 0; i < grid.size(); ++i) {
      for (int j = i + 1; j < grid.size(); ++j) {
        ASSERT_GE(distance(grid.centre(CellIndex::of(i)), grid.centre(CellIndex::of(j))), 1.3 - 1e-12);
      }
    }
  }
}

TEST(GridProperty, NearestIsWhatLookingAtAllCellsFinds) {
  const bool held = rc::check([](std::uint64_t seed) {
    Rng rng(seed);
    const Grid grid = random_grid(rng);
    const Point point = random_point(grid, rng);
    double least = 1e300;
    for (int i = 0; i < grid.size(); ++i) least = std::min(least, distance(grid.centre(CellIndex::of(i)), point));
    const CellIndex found = grid.nearest(point);
    RC_ASSERT(distance(grid.centre(found), point) <= least + 1e-9);
  });
  EXPECT_TRUE(held);
}

TEST(Grid, NearestTakesTheLowerIndexAmongEquals) {
  const Grid grid = grid_of(GridKind::square, 4, 4);
  EXPECT_EQ(grid.name(grid.nearest({0, 1})), "B1");
  EXPECT_EQ(grid.name(grid.nearest({0, 1.5})), "B2");
}

TEST(Grid, NearestOfAFarPointIsACellAtTheBorder) {
  for (const GridKind kind : kKinds) {
    const Grid grid = grid_of(kind, 5, 4);
    EXPECT_EQ(grid.cell(grid.nearest({-1e6, -1e6})).column, 0) << to_text(kind);
    EXPECT_EQ(grid.cell(grid.nearest({1e6, 2.0})).column, 4) << to_text(kind);
    EXPECT_EQ(grid.cell(grid.nearest({0, 1e6})).row, 3) << to_text(kind);
  }
}

TEST(GridProperty, EveryCentreIsNearestToItself) {
  for (const GridKind kind : kKinds) {
    const Grid grid = grid_of(kind, 9, 8, 0.7);
    for (int i = 0; i < grid.size(); ++i) {
      ASSERT_EQ(grid.nearest(grid.centre(CellIndex::of(i))), CellIndex::of(i)) << to_text(kind);
    }
  }
}

TEST(GridProperty, WithinIsWhatLookingAtAllCellsFinds) {
  const bool held = rc::check([](std::uint64_t seed) {
    Rng rng(seed);
    const Grid grid = random_grid(rng);
    const Point point = random_point(grid, rng);
    const double radius_m = rng.uniform() * 4;
    std::vector<CellIndex> expected;
    for (int i = 0; i < grid.size(); ++i) {
      const CellIndex index = CellIndex::of(i);
      if (squared_length(grid.centre(index) - point) <= radius_m * radius_m) expected.push_back(index);
    }
    RC_ASSERT(grid.within(point, radius_m) == expected);
  });
  EXPECT_TRUE(held);
}

double area_of(const std::vector<Point>& corners) {
  double twice = 0;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Point a = corners[k];
    const Point b = corners[(k + 1) % corners.size()];
    twice += a.x * b.y - a.y * b.x;
  }
  return twice / 2;
}

TEST(Grid, OutlinesHaveTheCellsAreaCounterClockwiseAroundTheCentre) {
  for (const GridKind kind : kKinds) {
    const Grid grid = grid_of(kind, 3, 3, 1.4);
    for (int i = 0; i < grid.size(); ++i) {
      const std::vector<Point> corners = grid.outline(CellIndex::of(i));
      EXPECT_EQ(corners.size(), kind == GridKind::square ? 4U : kind == GridKind::hexagonal ? 6U : 3U);
      EXPECT_NEAR(area_of(corners), grid.cell_area_m2(), 1e-12) << to_text(kind);
      Point middle;
      for (const Point corner : corners) middle = middle + (1.0 / static_cast<double>(corners.size())) * corner;
      expect_point(middle, grid.centre(CellIndex::of(i)));
    }
  }
}

TEST(Grid, NeighboursShareAnEdgeOfTheirOutlines) {
  for (const GridKind kind : kKinds) {
    const Grid grid = grid_of(kind, 6, 6);
    const CellIndex index = grid.index({3, 3});
    for (const CellIndex other : grid.neighbours(index)) {
      int shared = 0;
      for (const Point a : grid.outline(index)) {
        for (const Point b : grid.outline(other)) shared += distance(a, b) < 1e-9 ? 1 : 0;
      }
      EXPECT_EQ(shared, 2) << to_text(kind);
    }
  }
}

TEST(Grid, HasTheClearanceBoundOfTheSeparationTheorem) {
  EXPECT_DOUBLE_EQ(grid_of(GridKind::square, 2, 2, 2).clearance_bound_m(), std::numbers::sqrt2);
  EXPECT_DOUBLE_EQ(grid_of(GridKind::hexagonal, 2, 2, 2).clearance_bound_m(), kSqrt3);
  EXPECT_DOUBLE_EQ(grid_of(GridKind::triangular, 2, 2, 2).clearance_bound_m(), kSqrt3);
}

TEST(CellName, IsWrittenAsOnASpreadsheet) {
  EXPECT_EQ(cell_name({0, 0}), "A1");
  EXPECT_EQ(cell_name({25, 9}), "Z10");
  EXPECT_EQ(cell_name({26, 0}), "AA1");
  EXPECT_EQ(cell_name({51, 0}), "AZ1");
  EXPECT_EQ(cell_name({52, 0}), "BA1");
  EXPECT_EQ(cell_name({701, 0}), "ZZ1");
  EXPECT_EQ(cell_name({702, 4095}), "AAA4096");
  EXPECT_EQ(cell_name({83, 47}), "CF48");
}

TEST(CellName, IsReadBack) {
  const bool held = rc::check([](std::uint64_t seed) {
    Rng rng(seed);
    const Cell cell{static_cast<int>(rng.below(4096)), static_cast<int>(rng.below(4096))};
    RC_ASSERT(parse_cell(cell_name(cell)) == cell);
  });
  EXPECT_TRUE(held);
}

TEST(CellName, MayBeInLowerCase) { EXPECT_EQ(parse_cell("am3"), (Cell{38, 2})); }

TEST(CellName, IsRefusedWhenItIsNone) {
  for (const char* text : {"", "A", "1", "A0", "1A", "A-1", "A1 ", " A1", "A1B", "A1.5", "$A$1", "AAAAAAAAAA1",
                           "A99999999999999999999", "\xc3\x84\x31"}) {
    EXPECT_EQ(parse_cell(text), std::nullopt) << text;
  }
}

TEST(CellRangeText, TakesItsCornersInAnyOrder) {
  const CellRange expected{{0, 1}, {9, 47}};
  EXPECT_EQ(parse_cell_range("A2:J48"), expected);
  EXPECT_EQ(parse_cell_range("J48:A2"), expected);
  EXPECT_EQ(parse_cell_range("A48:J2"), expected);
  EXPECT_EQ(parse_cell_range("B2"), (CellRange{{1, 1}, {1, 1}}));
}

TEST(CellRangeText, IsRefusedWhenItIsNone) {
  for (const char* text : {"", ":", "A1:", ":A1", "A1:B2:C3", "A1-B2", "A:B"}) {
    EXPECT_EQ(parse_cell_range(text), std::nullopt) << text;
  }
}

TEST(GridKindText, IsReadBack) {
  for (const GridKind kind : kKinds) EXPECT_EQ(grid_kind_from(to_text(kind)), kind);
  EXPECT_EQ(grid_kind_from("Square"), std::nullopt);
  EXPECT_EQ(grid_kind_from(""), std::nullopt);
}

}  // namespace
}  // namespace footlight
