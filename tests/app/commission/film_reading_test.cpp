// SPDX-License-Identifier: Apache-2.0
#include "app/commission/film_reading.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/commission/findings.hpp"
#include "tests/app/commission/filmed_floor.hpp"
#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

using tests::FilmedFloor;
using tests::PhoneChoice;

const Grid& grid() {
  static const Grid kGrid = Grid::make(GridKind::square, 16, 9, 1).value();
  return kGrid;
}
const Rig& rig() {
  static const Rig kRig = tests::lamps_everywhere(grid(), {BusKind::can, BusKind::serial}, 115'200, 12);
  return kRig;
}
/// All lamps where the rig says, but two exchanged and one dead.
const FilmedFloor& floor() {
  static const FilmedFloor kFloor = [] {
    auto really = tests::cells_of(rig());
    std::swap(really[3], really[70]);
    return FilmedFloor(rig(), grid(), really, {100});
  }();
  return kFloor;
}

/// All lamps but the dead one are seen where they are.
void expect_found(const Result<FilmReading>& reading, const FilmedFloor& floor, const FitChoice& choice = {}) {
  ASSERT_TRUE(reading) << reading.error().message;
  const auto fit = fit_floor(*reading, floor.lamps(), floor.stage(), choice);
  ASSERT_TRUE(fit) << fit.error().message;
  const SeenPlaces places = places_of(*reading, *fit, floor.lamps().size());
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < floor.lamps().size(); ++i) {
    const std::optional<CellIndex> expected =
        floor.dead().contains(i) ? std::nullopt : std::optional(floor.really()[i]);
    wrong += places.cell[i] == expected ? 0 : 1;
  }
  EXPECT_EQ(wrong, 0U) << "fit by " << fit->by << ", " << reading->lights.size() << " lights, step "
                       << reading->timing.step_s << " s, fit " << reading->timing.fit;
}

TEST(FilmReading, FindsEveryLampInAQuietFilm) {
  const auto reading = floor().read({});
  expect_found(reading, floor());
  EXPECT_NEAR(reading->timing.step_s, floor().step_s(), 0.004);
  EXPECT_GT(reading->timing.fit, 0.97);
}

TEST(FilmReading, FindsEveryLampAtOtherRates) {
  for (const double fps : {24.0, 29.97, 60.0}) {
    PhoneChoice choice;
    choice.fps = fps;
    SCOPED_TRACE(fps);
    expect_found(floor().read(choice), floor());
  }
}

TEST(FilmReading, FindsEveryLampInSlowMotionAndWhenTheFilmsClockIsOff) {
  for (const double rate : {2.0, 1.03}) {
    PhoneChoice choice;
    choice.clock_rate = rate;
    SCOPED_TRACE(rate);
    expect_found(floor().read(choice), floor());
  }
}

TEST(FilmReading, FindsEveryLampFromAHandThatShakes) {
  PhoneChoice choice;
  choice.shake_px = 9;
  const auto reading = floor().read(choice);
  expect_found(reading, floor());
  EXPECT_GT(reading->most_moved_px, 6);
}

TEST(FilmReading, FindsEveryLampInNoiseWithReflectionsAndOtherLights) {
  PhoneChoice choice;
  choice.width = 640;
  choice.height = 360;
  choice.noise = 10;
  choice.reflection = 0.4;
  choice.steady_lights = 8;
  choice.light = 110;
  const auto reading = floor().read(choice);
  expect_found(reading, floor());
  EXPECT_GE(reading->steady, 4U);
}

TEST(FilmReading, FindsEveryLampFromUpstage) {
  PhoneChoice choice;
  choice.from_upstage = true;
  expect_found(floor().read(choice), floor());
}

TEST(FilmReading, OfAFloorOfWhichTheRigKnowsNothingGoesByTheGrid) {
  auto really = tests::cells_of(rig());
  Rng rng(7);
  for (std::size_t i = really.size() - 1; i > 0; --i) std::swap(really[i], really[rng.below(i + 1)]);
  const FilmedFloor mixed(rig(), grid(), really, {0, 15, 128});
  const auto reading = mixed.read({});
  expect_found(reading, mixed);
  EXPECT_EQ(fit_floor(*reading, mixed.lamps(), mixed.stage(), {})->by, "the grid");
}

TEST(FilmReading, AFilmWithoutLampsIsSaid) {
  PhoneChoice choice;
  choice.light = 0;
  const auto reading = floor().read(choice);
  ASSERT_FALSE(reading);
  EXPECT_EQ(reading.error().kind, ErrorKind::input);
  EXPECT_THAT(reading.error().message,
              testing::StartsWith("'film.mp4' shows no lamps: not a single point of light in "));
}

TEST(FilmReading, AFilmThatIsTooShortIsSaid) {
  PhoneChoice choice;
  choice.ends_s = 4;
  const auto reading = floor().read(choice);
  ASSERT_FALSE(reading);
  EXPECT_EQ(reading.error().message,
            "'film.mp4' is too short: 5.5 s, and the sequence takes 18.4 s (film from before the first flash until "
            "after the last one)");
}

TEST(FilmReading, AFilmOfAnotherRigIsSaid) {
  Rig other = rig();
  other.nodes[2].address = 99;
  const FlashSequence sequence(LampCode(floor().lamps().size(), wiring_tag(other)));
  const auto reading = read_flashes(floor().film({}), sequence, floor().step_s(), "film.mp4");
  ASSERT_FALSE(reading);
  EXPECT_EQ(reading.error().message,
            "'film.mp4' shows the flash sequence of another rig: 0 of 143 flashing lights have a word of this one (the "
            "rig must have the buses, nodes and channels with which the sequence was played)");
}

TEST(FilmReading, AFilmOfSomethingElseIsSaid) {
  // Lamps that shine all the time.
  tests::Phone phone({}, grid(), floor().really());
  const auto film = phone.spots(
      30, [](std::size_t, double) { return 1.0; }, 1.3);
  const auto reading = read_flashes(film, floor().sequence(), floor().step_s(), "film.mp4");
  ASSERT_FALSE(reading);
  EXPECT_THAT(reading.error().message,
              testing::MatchesRegex("'film.mp4' does not show the flash sequence of this rig's 144 lamps: the best fit "
                                    "is 0..., 0.85 is needed .film all of it, .*"));
}

}  // namespace
}  // namespace footlight::app
