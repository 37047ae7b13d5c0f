// SPDX-License-Identifier: Apache-2.0
#include "app/commission/floor_fit.hpp"

#include <numeric>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"
#include "tests/support/phone.hpp"
#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

/// A floor seen from somewhere, without a film between.
struct View {
  Stage stage;
  Rig rig;
  std::vector<FloorLamp> lamps;
  FilmReading reading;
  tests::PhoneChoice choice;

  View(GridKind kind, int columns, int rows, const tests::PhoneChoice& from) : choice(from) {
    stage.grid = Grid::make(kind, columns, rows, 1).value();
    rig = tests::lamps_everywhere(stage.grid, {BusKind::can}, 115'200, 16);
    lamps = lamps_of(rig);
    std::vector<CellIndex> places;
    for (const FloorLamp& lamp : lamps) places.push_back(*lamp.cell);
    see(places);
  }
  /// @param places where the lamps are
  void see(const std::vector<CellIndex>& places) {
    const tests::Phone phone(choice, stage.grid, places);
    reading.lights.clear();
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Point at = phone.project(stage.grid.centre(places[i]));
      reading.lights.push_back({{static_cast<float>(at.x), static_cast<float>(at.y), 100}, i, false});
    }
  }
  [[nodiscard]] std::size_t wrong(const FloorFit& fit, const std::vector<CellIndex>& places) const {
    std::size_t sum = 0;
    for (std::size_t i = 0; i < places.size(); ++i) sum += fit.cell[i] == places[i] ? 0 : 1;
    return sum;
  }
};

tests::PhoneChoice anywhere(Rng& rng) {
  tests::PhoneChoice choice;
  choice.width = 1280;
  choice.height = 720;
  choice.height_m = 4 + 12 * rng.uniform();
  choice.away_m = 3 + 15 * rng.uniform();
  choice.aside_m = -6 + 12 * rng.uniform();
  choice.from_upstage = rng.below(2) == 0;
  return choice;
}

TEST(FloorFit, ByTheRigFromAnywhereWithLampsExchanged) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint64_t>());
    const GridKind kind = *rc::gen::element(GridKind::square, GridKind::hexagonal, GridKind::triangular);
    View view(kind, 14, 9, anywhere(rng));
    std::vector<CellIndex> places;
    for (const FloorLamp& lamp : view.lamps) places.push_back(*lamp.cell);
    for (int i = 0; i < 25; ++i) std::swap(places[rng.below(places.size())], places[rng.below(places.size())]);
    view.see(places);
    const auto fit = fit_floor(view.reading, view.lamps, view.stage, {});
    RC_ASSERT(bool(fit));
    RC_ASSERT(fit->by == "the rig");
    RC_ASSERT(fit->from == (view.choice.from_upstage ? Viewpoint::upstage : Viewpoint::audience));
    RC_ASSERT(view.wrong(*fit, places) == 0U);
  }));
}

TEST(FloorFit, ByTheGridOfAnyPermutation) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint64_t>());
    View view(GridKind::square, 14, 9, anywhere(rng));
    std::vector<CellIndex> places;
    for (const FloorLamp& lamp : view.lamps) places.push_back(*lamp.cell);
    for (std::size_t i = places.size() - 1; i > 0; --i) std::swap(places[i], places[rng.below(i + 1)]);
    view.see(places);
    FitChoice choice;
    if (view.choice.from_upstage) choice.from = Viewpoint::upstage;
    const auto fit = fit_floor(view.reading, view.lamps, view.stage, choice);
    RC_ASSERT(bool(fit));
    RC_ASSERT(fit->by == "the grid");
    RC_ASSERT(view.wrong(*fit, places) == 0U);
  }));
}

TEST(FloorFit, ByTheCornersThatAreGiven) {
  View view(GridKind::square, 14, 9, {});
  std::vector<CellIndex> places;
  for (const FloorLamp& lamp : view.lamps) places.push_back(*lamp.cell);
  std::ranges::reverse(places);
  view.see(places);
  const tests::Phone phone(view.choice, view.stage.grid, places);
  FitChoice choice;
  const auto at = [&](int column, int row) { return phone.project(view.stage.grid.centre({column, row})); };
  choice.corners = std::array<Point, 4>{at(0, 0), at(13, 0), at(13, 8), at(0, 8)};
  const auto fit = fit_floor(view.reading, view.lamps, view.stage, choice);
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_EQ(fit->by, "the corners");
  EXPECT_EQ(view.wrong(*fit, places), 0U);
}

TEST(FloorFit, AFloorTurnedRoundIsRightOnlyFromTheOtherSide) {
  View view(GridKind::square, 14, 9, {});
  std::vector<CellIndex> places;
  for (const FloorLamp& lamp : view.lamps) places.push_back(*lamp.cell);
  std::ranges::reverse(places);  // all lamps turned by half a turn
  view.see(places);
  const auto believed = fit_floor(view.reading, view.lamps, view.stage, {});
  ASSERT_TRUE(believed);
  EXPECT_EQ(believed->from, Viewpoint::upstage) << "as if the film came from the other side";
  FitChoice choice;
  choice.from = Viewpoint::audience;
  const auto fit = fit_floor(view.reading, view.lamps, view.stage, choice);
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_EQ(fit->by, "the grid");
  EXPECT_EQ(view.wrong(*fit, places), 0U);
}

TEST(FloorFit, AMirroredRigIsNotBelieved) {
  View view(GridKind::square, 14, 9, {});
  std::vector<CellIndex> places;
  for (const FloorLamp& lamp : view.lamps) {
    const Cell cell = view.stage.grid.cell(*lamp.cell);
    places.push_back(view.stage.grid.index({13 - cell.column, cell.row}));
  }
  view.see(places);
  const auto fit = fit_floor(view.reading, view.lamps, view.stage, {});
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_EQ(fit->by, "the grid");
  EXPECT_EQ(view.wrong(*fit, places), 0U);
}

TEST(FloorFit, LightsOnNoGridAreSaid) {
  View view(GridKind::square, 14, 9, {});
  Rng rng(3);
  for (SeenLight& light : view.reading.lights) {
    light.place.x = static_cast<float>(640 * rng.uniform());
    light.place.y = static_cast<float>(360 * rng.uniform());
  }
  view.reading.reference_s = 2.5;
  const auto fit = fit_floor(view.reading, view.lamps, view.stage, {});
  ASSERT_FALSE(fit);
  EXPECT_EQ(
      fit.error().message,
      "the 126 lights of the film do not come onto the 14 x 9 cells of the stage, neither by the rig nor by their "
      "grid (--corners tells where the corners are in the frame at 2.50 s, --from where the film was taken)");
}

TEST(SeenPlaces, TheBrightestLightOfALampCountsAndTwoLampsOnOneCellDoNot) {
  FilmReading reading;
  FloorFit fit;
  const auto add = [&](std::optional<std::size_t> lamp, float light, std::optional<CellIndex> cell) {
    reading.lights.push_back({{0, 0, light}, lamp, false});
    fit.cell.push_back(cell);
  };
  add(0, 100, CellIndex(5));
  add(0, 30, CellIndex(6));  // its reflection
  add(1, 90, CellIndex(7));
  add(2, 90, CellIndex(7));
  add(3, 90, std::nullopt);
  add(std::nullopt, 90, CellIndex(8));
  const SeenPlaces places = places_of(reading, fit, 5);
  EXPECT_EQ(places.cell[0], CellIndex(5));
  EXPECT_EQ(places.cell[1], std::nullopt);
  EXPECT_EQ(places.cell[2], std::nullopt);
  EXPECT_EQ(places.cell[3], std::nullopt);
  EXPECT_EQ(places.unread, (std::vector<CellIndex>{CellIndex(7), CellIndex(8)}));
  EXPECT_EQ(places.reflections, 1U);
  EXPECT_EQ(places.beside, 1U);
}

}  // namespace
}  // namespace footlight::app
