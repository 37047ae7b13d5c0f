// SPDX-License-Identifier: Apache-2.0
#include "app/import/fitting_grid.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"

namespace footlight::app {
namespace {

Imported with(const std::vector<Point>& points) {
  Imported out;
  out.files = {"list.csv"};
  ImportedFormation formation{"set 1", 1, 0, {}};
  int line = 2;
  for (const Point& at : points) {
    out.people.push_back({"p" + std::to_string(line - 1), std::nullopt});
    formation.places.push_back({at, 0, line++, 3});
  }
  out.formations.push_back(formation);
  return out;
}
Result<FittingGrid> fit(const std::vector<Point>& points, const GridChoice& choice = {}) {
  const Imported imported = with(points);
  return fitting_grid(imported, imported.formations[0].places, choice);
}

TEST(FittingGrid, PlacesOfAnotherGridAreCellsAgainWithoutAShift) {
  const bool held = rc::check([](std::uint64_t seed) {
    Rng rng(seed);
    constexpr double kPitches[] = {1, 0.5, 0.8, 2, 0.5715, 0.3};
    const Grid grid = *Grid::make(GridKind::square, 2 + static_cast<int>(rng.below(40)),
                                  2 + static_cast<int>(rng.below(40)), kPitches[rng.below(6)]);
    std::vector<Point> points;
    for (int k = 0; k < 30; ++k) {
      points.push_back(
          grid.centre(CellIndex::of(static_cast<int>(rng.below(static_cast<std::uint64_t>(grid.size()))))));
    }
    const auto found = fit(points);
    RC_ASSERT(found.has_value());
    RC_ASSERT(found->shift == Point{});
    for (const Point& at : points) RC_ASSERT(found->off_m(at) < 1e-9);
  });
  EXPECT_TRUE(held);
}

TEST(FittingGrid, IsTheCoarsestThatFits) {
  EXPECT_EQ(fit({{0, 0.5}, {1, 0.5}, {3, 2.5}})->grid.pitch_m(), 1);
  EXPECT_EQ(fit({{0, 0.25}, {0.5, 0.25}, {3, 2.75}})->grid.pitch_m(), 0.5);
  EXPECT_EQ(fit({{0, 1}, {2, 1}, {4, 3}})->grid.pitch_m(), 2);
}

TEST(FittingGrid, ShiftsWhatLiesBesideEveryGrid) {
  // The front side line, and steps behind it: y = 0 would be the edge of a cell.
  const auto steps = fit({{0, 0}, {0.5715, 0}, {-0.5715, 3 * 0.5715}}, {std::nullopt, std::nullopt, 1, 0});
  ASSERT_TRUE(steps);
  EXPECT_EQ(steps->grid.pitch_m(), 0.5715);
  EXPECT_EQ(steps->shift, (Point{0, 0.5715 / 2}));
  // In front of the stage's edge.
  const auto front = fit({{0.5, -3.5}, {1.5, 2.5}});
  ASSERT_TRUE(front);
  EXPECT_GE(front->grid.cell(front->cell({0.5, -3.5})).row, 0);
  EXPECT_NEAR(front->off_m({0.5, -3.5}), 0, 1e-9);
}

TEST(FittingGrid, WhatIsNoCellIsToldWithItsPlaceAndHowFarItIs) {
  EXPECT_EQ(
      fit({{0.5, 0.5}, {1.5, 0.5}, {2.8, 0.613}}, {std::nullopt, 1.0, 2, 0}).error().message,
      "list.csv:4:3: error: x 2.8 m, y 0.613 m is no middle of a cell: H1 is 0.321 m away on a grid of 1 m (another "
      "--pitch, or --snap '0.33 m' to move people that far)");
  const auto snapped = fit({{0.5, 0.5}, {1.5, 0.5}, {2.8, 0.613}}, {std::nullopt, 1.0, 2, 0.33});
  ASSERT_TRUE(snapped) << snapped.error();
  const Imported imported = with({{0.5, 0.5}, {1.5, 0.5}, {2.8, 0.613}});
  const auto on = cells_of(imported, *snapped);
  ASSERT_TRUE(on);
  EXPECT_EQ(on->moved, 1U);
  EXPECT_NEAR(on->largest_move_m, 0.3206, 1e-4);
  EXPECT_EQ(on->farthest_person, 2U);
}

TEST(FittingGrid, IsNoLargerThanAStage) {
  EXPECT_EQ(fit({{0, 0.05}, {0.1, 0.05}, {9000.3, 0.05}}).error().message.substr(0, 32),
            "the places need a grid of 180011");
}

TEST(CellsOf, TwoPeopleOnOneCellAreTold) {
  const Imported imported = with({{0.5, 0.5}, {1.5, 0.5}, {1.4, 0.5}});
  const FittingGrid grid{*Grid::make(GridKind::square, 8, 4, 1), {}, 0.2};
  EXPECT_EQ(
      cells_of(imported, grid).error().message,
      "list.csv:4:3: error: performers p2 and p3 both stand on F1 in set 1 (count 1) (the first in list.csv:3; one "
      "person on each cell)");
}

}  // namespace
}  // namespace footlight::app
