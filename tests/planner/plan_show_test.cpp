// SPDX-License-Identifier: Apache-2.0
#include "planner/plan_show.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <tbb/global_control.h>

#include "core/rng.hpp"
#include "planner/measure.hpp"
#include "planner/schedule/ways.hpp"
#include "planner/validate.hpp"
#include "tests/planner/small_show.hpp"

namespace footlight::planner {
namespace {

using Films = std::vector<std::optional<Film>>;

using test::cells_in;
using test::section_of;
using test::show_with;
using test::video;

/// A disc that grows from nothing and then wanders.
Film growing_film() {
  return tests::film_of(
      60, [](int f) { return f == 0 ? Mask(80, 60) : tests::disc(80, 60, 30 + f / 3.0, 30, std::min(f, 30) * 0.6); });
}

Show growing_show(int people, GridKind kind = GridKind::square) {
  Show show = show_with(people, kind);
  show.stage.reserve = cells_in(show.stage.grid, "A1:D20");
  show.sections.push_back(section_of("growth", video(), 1, 120, 4, 31));
  return show;
}

void expect_sound(const Planned& planned, const Show& show) {
  EXPECT_TRUE(planned.plan.valid) << testing::PrintToString(planned.refusal);
  EXPECT_TRUE(planned.refusal.empty());
  EXPECT_EQ(planned.plan.tracks.size(), show.performers.size());
  for (const Formation& formation : planned.plan.formations) {
    EXPECT_EQ(std::set<CellIndex>(formation.cells.begin(), formation.cells.end()).size(), show.performers.size());
  }
}

TEST(PlanShow, GrowsAPictureOutOfTheReserveOnEveryGrid) {
  for (const GridKind kind : {GridKind::square, GridKind::hexagonal, GridKind::triangular}) {
    const Show show = growing_show(70, kind);
    const auto planned = plan_show(show, {growing_film()});
    ASSERT_TRUE(planned) << planned.error().message;
    expect_sound(*planned, show);
    EXPECT_EQ(planned->plan.formations.front().in_picture, 0);
    EXPECT_EQ(planned->plan.formations.front().id, "growth/1");
    EXPECT_GT(planned->plan.formations.back().in_picture, 60);
    EXPECT_EQ(planned->plan.tracks[0].front().time, kStart);
    EXPECT_EQ(planned->plan.tracks[0].back().time, show.tempo.at(125));
    EXPECT_EQ(planned->plan.transitions.size() + 1, planned->plan.formations.size());
  }
}

TEST(PlanShow, IsTheSameForAnyNumberOfThreads) {
  const Show show = growing_show(70);
  std::vector<Plan> plans;
  for (const std::size_t threads : {1U, 2U, 8U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    plans.push_back(plan_show(show, {growing_film()})->plan);
  }
  EXPECT_EQ(plans[0], plans[1]);
  EXPECT_EQ(plans[0], plans[2]);
}

TEST(PlanShow, PlansDrawingAndWalksTogetherOnEveryGrid) {
  for (const GridKind kind : {GridKind::square, GridKind::hexagonal, GridKind::triangular}) {
    Show show = growing_show(70, kind);
    show.sections[0].planner.model = PlannerModel::joint;
    show.stage.blocked = cells_in(show.stage.grid, "N6:O8");
    const auto planned = plan_show(show, {growing_film()});
    ASSERT_TRUE(planned) << planned.error().message;
    expect_sound(*planned, show);
    EXPECT_GT(planned->plan.formations.back().in_picture, 60);
  }
}

TEST(PlanShow, DrawsBetterAndWalksLessWhenItPlansBothTogether) {
  Show show = show_with(60);
  show.sections.push_back(section_of("wander", video(), 1, 60, 0, 31));
  const Film film = tests::film_of(40, [](int f) { return tests::disc(80, 60, 20 + f, 30, 14); });
  std::vector<Measures> measured;
  for (const PlannerModel model : {PlannerModel::flat, PlannerModel::hierarchical, PlannerModel::joint}) {
    show.sections[0].planner.model = model;
    const auto planned = plan_show(show, {film});
    ASSERT_TRUE(planned) << planned.error().message;
    expect_sound(*planned, show);
    measured.push_back(measure(planned->plan, {film}).show);
  }
  for (const std::size_t other : {0U, 1U}) {
    EXPECT_LT(*measured[2].theta_iou, *measured[other].theta_iou);
    EXPECT_LT(*measured[2].theta_dev, *measured[other].theta_dev);
  }
  EXPECT_LE(measured[2].total_distance_m, 1.5 * measured[0].total_distance_m);
}

/// Four hundred people, so that prices are found on coarser blocks first.
TEST(PlanShow, DrawsAPictureOfHundredsThatMovesAwayAsFastAsTheyWalk) {
  Show show = show_with(400, GridKind::square, 64, 40);
  show.sections.push_back(section_of("wander", video(), 1, 40, 0, 31));
  const Film film = tests::film_of(41, [](int f) { return tests::disc(128, 80, 38 + f, 40, 22); });
  const auto planned = plan_show(show, {film});
  ASSERT_TRUE(planned) << planned.error().message;
  expect_sound(*planned, show);
  EXPECT_LT(*measure(planned->plan, {film}).show.theta_iou, 0.2);
}

/// A film that begins too far away for the time before it: whoever needs longer comes later, and nobody is refused.
TEST(PlanShow, IsNotRefusedWhereAFilmBeginsTooFarAway) {
  for (const double start : {13.0, 25.0}) {
    Show show = show_with(90, GridKind::square, 60, 16);
    show.sections.push_back(section_of("near", video(), 1, 10, 0, 31));
    show.sections.push_back(section_of("far", video(), start, 40, 0, 32));
    const Film near = tests::film_of(11, [](int) { return tests::disc(240, 64, 40, 32, 20); });
    const Film far = tests::film_of(41, [](int) { return tests::disc(240, 64, 200, 32, 20); });
    const auto planned = plan_show(show, {near, far});
    ASSERT_TRUE(planned) << planned.error().message;
    EXPECT_TRUE(planned->plan.valid) << testing::PrintToString(planned->refusal);
    expect_sound(*planned, show);
    EXPECT_GT(planned->plan.formations.back().in_picture, 80);
  }
}

TEST(PlanShow, TheJointPlanIsTheSameForAnyNumberOfThreads) {
  Show show = growing_show(70);
  show.sections[0].planner.model = PlannerModel::joint;
  std::vector<Plan> plans;
  for (const std::size_t threads : {1U, 8U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    plans.push_back(plan_show(show, {growing_film()})->plan);
  }
  EXPECT_EQ(plans[0], plans[1]);
}

TEST(PlanShow, MoreEffortSavesStepsAndLosesDrawing) {
  Show show = growing_show(70);
  show.sections[0].planner.model = PlannerModel::joint;
  std::vector<double> walked_m;
  for (const double effort : {0.1, 1.0, 100.0}) {
    show.sections[0].planner.effort = effort;
    const auto planned = plan_show(show, {growing_film()});
    ASSERT_TRUE(planned) << planned.error().message;
    expect_sound(*planned, show);
    walked_m.push_back(0);
    for (const auto& track : planned->plan.tracks) {
      for (std::size_t n = 1; n < track.size(); ++n) {
        const Grid& grid = show.stage.grid;
        walked_m.back() += distance(grid.centre(track[n - 1].cell), grid.centre(track[n].cell));
      }
    }
  }
  EXPECT_LE(walked_m[1], walked_m[0]);
  EXPECT_LT(walked_m[2], walked_m[1] / 2);
}

TEST(PlanShow, KeepsOffBlockedCellsAndGoesAroundThem) {
  Show show = growing_show(50);
  show.stage.blocked = cells_in(show.stage.grid, "N6:O15");
  const auto planned = plan_show(show, {growing_film()});
  ASSERT_TRUE(planned) << planned.error().message;
  expect_sound(*planned, show);
}

/// As many cells as performers on which somebody may stand: spread anywhere or close together around a point.
CellsSource anywhere(Rng& rng, const Show& show) {
  const Grid& grid = show.stage.grid;
  const Ways ways(show.stage, show.stage.clearance_m / 2);
  const bool close = rng.below(2) == 0;
  const Point middle = grid.centre(CellIndex::of(rng.below(static_cast<std::uint64_t>(grid.size()))));
  std::vector<std::pair<double, CellIndex>> free;
  for (std::size_t i = 0; i < static_cast<std::size_t>(grid.size()); ++i) {
    const CellIndex cell = CellIndex::of(i);
    if (ways.can_stand(cell)) free.emplace_back(close ? distance(grid.centre(cell), middle) : rng.uniform(), cell);
  }
  std::sort(free.begin(), free.end());
  CellsSource source{"cells.csv", {}, false};
  for (std::size_t p = 0; p < show.performers.size(); ++p) source.cells.push_back(free[p].second);
  return source;
}

TEST(PlanShow, ASetPieceInTheMiddleIsWalkedAroundWhereThereIsTime) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    const bool from_film = rng.below(3) == 0;
    const int most = from_film ? 48 : 90;
    Show show = show_with(1 + static_cast<int>(rng.below(most)), static_cast<GridKind>(rng.below(3)), 16, 12);
    if (from_film) show.stage.reserve = cells_in(show.stage.grid, "A1:D12");
    constexpr const char* kSetPieces[] = {"H4:I9", "D6:M7", "G5:J8", "H3:H12"};
    show.stage.blocked = cells_in(show.stage.grid, kSetPieces[rng.below(4)]);
    // Three times the way from corner to corner.
    const double counts = std::ceil(3 * 26 / show.stage.max_speed_mps * 2);
    std::vector<std::optional<Film>> films(2);
    double start = 1;
    for (int s = 0; s < 2; ++s) {
      if (s == 0 && from_film) {
        show.sections.push_back(section_of("film", video(), start, 40, 0, 31));
        films[0] = tests::film_of(20, [](int f) { return tests::disc(48, 36, 10 + f, 18, 12); });
        start += 40;
      } else {
        show.sections.push_back(section_of("cells", anywhere(rng, show), start, 0, 2, 31));
        start += 2;
      }
      start += counts;
    }
    const auto planned = plan_show(show, films);
    RC_ASSERT((planned ? "" : planned.error().message) == std::string());
    RC_ASSERT(planned->refusal == std::vector<std::string>{});
    RC_ASSERT(planned->plan.valid);
  }));
}

TEST(PlanShow, AnyFilmIsValidOrTheDrawingGivesWay) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    Show show = show_with(1 + static_cast<int>(rng.below(60)), static_cast<GridKind>(rng.below(3)), 16, 12);
    if (rng.below(2) == 0) show.stage.reserve = cells_in(show.stage.grid, "A1:D12");
    if (rng.below(2) == 0) show.stage.blocked = cells_in(show.stage.grid, "J5:K6");
    show.stage.max_speed_mps = 0.3 + 2 * rng.uniform();
    show.sections.push_back(section_of("film", video(), 1, 10 + static_cast<double>(rng.below(60)), 0, 31));
    show.sections.back().planner.model = rng.below(2) == 0 ? PlannerModel::flat : PlannerModel::hierarchical;
    show.sections.back().planner.region_size = 10;
    const int cut = static_cast<int>(rng.below(24));
    const Film film = tests::film_of(24, [&](int f) {
      return f < cut ? tests::disc(48, 36, 10 + f, 12, 9)
                     : tests::mask_where(48, 36, [](int x, int) { return x % 9 < 4; });
    });
    const auto planned = plan_show(show, {film});
    RC_ASSERT(planned.has_value());
    RC_ASSERT(planned->refusal.empty());
    RC_ASSERT(planned->plan.valid);
  }));
}

TEST(PlanShow, NamedPeopleStandWhereTheListSays) {
  Show show = growing_show(40);
  std::vector<CellIndex> bow = cells_in(show.stage.grid, "L3:U6");
  std::reverse(bow.begin(), bow.end());
  show.sections.push_back(section_of("bow", CellsSource{"bow.csv", bow}, 190, 0, 8, 34));
  const auto planned = plan_show(show, {growing_film(), std::nullopt});
  ASSERT_TRUE(planned) << planned.error().message;
  expect_sound(*planned, show);
  EXPECT_EQ(planned->plan.formations.back().id, "bow/1");
  EXPECT_EQ(planned->plan.formations.back().cells, bow);
}

TEST(PlanShow, RefusesASectionThatCannotBeWalkedAndSaysWhatWouldDo) {
  Show show = show_with(2, GridKind::square, 40, 4);
  show.sections.push_back(section_of(
      "start", CellsSource{"start.csv", {show.stage.grid.index({0, 0}), show.stage.grid.index({0, 2})}}, 1, 0, 8, 31));
  show.sections.push_back(section_of(
      "bow", CellsSource{"bow.csv", {show.stage.grid.index({31, 0}), show.stage.grid.index({4, 2})}}, 17, 0, 8, 34));
  const auto planned = plan_show(show, {std::nullopt, std::nullopt});
  ASSERT_TRUE(planned);
  EXPECT_FALSE(planned->plan.valid);
  EXPECT_THAT(
      planned->refusal,
      testing::ElementsAre(
          "show.yaml:34:5: error: sections[1]: performer 1 would walk 31.0 m from A1 to AF1 between count 9 and "
          "count 17 at 7.8 m/s, 5.5 times the limit of 1.4 m/s (start the section 37 counts later, hold the "
          "one before shorter, or slow the music to 21 counts a minute)"));
}

TEST(PlanShow, EveryTransitionToleratesTheLagOfTheStage) {
  for (const PlannerModel model : {PlannerModel::flat, PlannerModel::hierarchical, PlannerModel::joint}) {
    Show show = growing_show(70);
    show.sections[0].planner.model = model;
    const auto planned = plan_show(show, {growing_film()});
    ASSERT_TRUE(planned) << planned.error().message;
    expect_sound(*planned, show);
    for (const TransitionFacts& facts : planned->plan.transitions) EXPECT_GE(facts.tolerated_lag_s, 0.2 - 1e-9);
  }
}

TEST(PlanShow, SaysWhereTheLagIsNotToleratedAndRefusesNothingForIt) {
  Show show = show_with(2, GridKind::square, 40, 4);
  show.stage.lag = seconds(1.5);
  const auto at = [&](int column) { return show.stage.grid.index({column, 0}); };
  show.sections.push_back(section_of("start", CellsSource{"start.csv", {at(0), at(1)}}, 1, 0, 0, 31));
  show.sections.push_back(section_of("on", CellsSource{"on.csv", {at(14), at(15)}}, 22, 0, 0, 34));
  const auto planned = plan_show(show, {std::nullopt, std::nullopt});
  ASSERT_TRUE(planned);
  EXPECT_TRUE(planned->plan.valid);
  ASSERT_EQ(planned->plan.sections[1].notes.size(), 1U);
  EXPECT_THAT(planned->plan.sections[1].notes.front(),
              testing::StartsWith("in 1 of 1 transitions people come too near when they are 1.5 s late; least is "
                                  "tolerated, 0.375 s, in the one from count 1; walks of at most 0.14 m/s tolerate it: "
                                  "a longer section"));
}

TEST(PlanShow, NamedPeopleWhoseWaysCrossWalkOneAfterTheOther) {
  Show show = show_with(2, GridKind::square, 20, 20);
  const auto at = [&](int column, int row) { return show.stage.grid.index({column, row}); };
  show.sections.push_back(section_of("start", CellsSource{"start.csv", {at(2, 6), at(6, 6)}}, 1, 0, 0, 31));
  show.sections.push_back(section_of("cross", CellsSource{"cross.csv", {at(6, 2), at(2, 2)}}, 17, 0, 0, 34));
  const auto planned = plan_show(show, {std::nullopt, std::nullopt});
  ASSERT_TRUE(planned);
  expect_sound(*planned, show);
  EXPECT_EQ(planned->plan.formations.back().cells, (std::vector<CellIndex>{at(6, 2), at(2, 2)}));
  EXPECT_GE(planned->plan.transitions.front().tolerated_lag_s, 0.2 - 1e-9);
  ASSERT_EQ(planned->plan.sections[1].notes.size(), 1U);
  EXPECT_THAT(planned->plan.sections[1].notes.front(), testing::HasSubstr("made one after the other"));
}

TEST(PlanShow, WideBodiesKeepOffSetPiecesAllTheWay) {
  Show show = show_with(1, GridKind::square, 12, 12);
  show.performers[0].radius_m = 0.6;
  show.stage.blocked = cells_in(show.stage.grid, "F6:F6");
  const auto at = [&](int column, int row) { return show.stage.grid.index({column, row}); };
  show.sections.push_back(section_of("start", CellsSource{"start.csv", {at(1, 4)}}, 1, 0, 0, 31));
  show.sections.push_back(section_of("on", CellsSource{"on.csv", {at(9, 4)}}, 33, 0, 0, 34));
  const auto planned = plan_show(show, {std::nullopt, std::nullopt});
  ASSERT_TRUE(planned);
  expect_sound(*planned, show);
  for (const Mark& mark : planned->plan.tracks[0]) {
    EXPECT_GT(distance(show.stage.grid.centre(mark.cell), show.stage.grid.centre(at(5, 5))), 1.05);
  }
}

Show show_of_a_swap(double count) {
  Show show = show_with(2, GridKind::square, 12, 4);
  const CellIndex left = show.stage.grid.index({1, 1});
  const CellIndex right = show.stage.grid.index({8, 1});
  show.sections.push_back(section_of("start", CellsSource{"start.csv", {left, right}}, 1, 0, 0, 31));
  show.sections.push_back(section_of("swap", CellsSource{"swap.csv", {right, left}}, count, 0, 0, 34));
  return show;
}

TEST(PlanShow, NamedPeopleWhoWouldMeetGoAroundEachOtherWithMarksOfTheirOwn) {
  const Show show = show_of_a_swap(33);
  const auto planned = plan_show(show, {std::nullopt, std::nullopt});
  ASSERT_TRUE(planned);
  expect_sound(*planned, show);
  EXPECT_EQ(planned->plan.formations.back().cells, std::get<CellsSource>(show.sections[1].from).cells);
  for (const TransitionFacts& facts : planned->plan.transitions) EXPECT_GE(facts.tolerated_lag_s, 0.2 - 1e-9);
  EXPECT_THAT(planned->plan.sections[1].notes,
              testing::ElementsAre(testing::MatchesRegex(
                  "between count 1 and count 33 1 person goes around others with [12] marks? of her own on the way: "
                  "[78]\\.[0-9] m instead of 7.0 m")));
  // The other walks as if nobody met her.
  const auto& tracks = planned->plan.tracks;
  EXPECT_EQ(std::min(tracks[0].size(), tracks[1].size()), 2U);
}

TEST(PlanShow, NamedPeopleWhoHaveNoTimeToPassEachOtherAreRefusedWithTheTimeThatWouldDo) {
  const auto planned = plan_show(show_of_a_swap(11.5), {std::nullopt, std::nullopt});
  ASSERT_TRUE(planned);
  EXPECT_FALSE(planned->plan.valid);
  ASSERT_EQ(planned->refusal.size(), 2U);
  EXPECT_THAT(
      planned->refusal.front(),
      testing::MatchesRegex("show.yaml:34:5: error: sections\\[1\\]: performers 1 and 2 cannot pass each other on "
                            "the way between count 1 and count 11.5: with marks on it it takes [5-7]\\.[0-9] s "
                            "of 5.2 s, performer [12] being the last \\(start the section [1-4] counts? later, or "
                            "give them places that they may exchange\\)"));
  EXPECT_THAT(planned->refusal.back(), testing::StartsWith("show.yaml:34:5: error: sections[1]: performers 1 "));
  // And it would do.
  const auto later = plan_show(show_of_a_swap(15.5), {std::nullopt, std::nullopt});
  EXPECT_TRUE(later->plan.valid);
}

TEST(PlanShow, MorePeopleThanCellsIsAnInputError) {
  Show show = show_with(700);
  show.sections.push_back(section_of("film", video(), 1, 40, 0, 31));
  const auto planned = plan_show(show, {growing_film()});
  ASSERT_FALSE(planned);
  EXPECT_EQ(planned.error().kind, ErrorKind::input);
  EXPECT_EQ(planned.error().message,
            "show.yaml:31:5: error: sections[0]: 700 performers, but the stage has 600 cells to stand on (a larger "
            "grid, a smaller pitch or fewer performers)");
}

TEST(PlanShow, MorePeopleThanTheLargestPictureAndTheReserveHoldIsAnInputError) {
  Show show = show_with(100);
  show.stage.reserve = cells_in(show.stage.grid, "A1:A10");
  VideoSource contained = video();
  contained.picture.fit = Fit::contain;
  show.sections.push_back(section_of("dot", contained, 1, 40, 0, 31));
  const Film dot = tests::film_of(10, [](int) { return tests::disc(58, 40, 21, 21, 1); });
  const auto planned = plan_show(show, {dot});
  ASSERT_FALSE(planned);
  EXPECT_EQ(planned.error().message,
            "show.yaml:31:5: error: sections[0]: 100 performers, but the largest picture of 'film.mp4' holds 1 and the "
            "reserve 10 (at least 89 more reserve cells, a larger floor, fit: area, or fewer performers)");
}

TEST(PlanShow, NoCellLeftForThePictureIsAnInputError) {
  Show show = show_with(24, GridKind::square, 24, 20);
  const char* text =
      "show.yaml:31:5: error: sections[0]: no cell is left for the picture beside reserve and blocked cells (free some "
      "cells)";
  show.sections.push_back(section_of("film", video(), 1, 40, 0, 31));
  show.stage.reserve = cells_in(show.stage.grid, "A1:X20");
  const auto all_reserve = plan_show(show, {growing_film()});
  ASSERT_FALSE(all_reserve);
  EXPECT_EQ(all_reserve.error().kind, ErrorKind::input);
  EXPECT_EQ(all_reserve.error().message, text);
  show.stage.reserve = cells_in(show.stage.grid, "A1:X19");
  show.stage.blocked = cells_in(show.stage.grid, "A20:X20");
  show.sections[0].from = ImageSource{"disc.png", {}};
  const auto blocked = plan_show(show, {tests::film_of(1, [](int) { return tests::disc(60, 60, 30, 30, 20); })});
  ASSERT_FALSE(blocked);
  EXPECT_EQ(blocked.error().message, text);
}

TEST(PlanShow, OneWidePersonKeepsTheOthersNoFartherApartThanHerRadiusAndTheNextAsk) {
  Show show = growing_show(70);
  const auto usual = plan_show(show, {growing_film()});
  show.performers[3].radius_m = 0.4;
  show.performers[7].radius_m = 0.1;
  const auto planned = plan_show(show, {growing_film()});
  ASSERT_TRUE(usual && planned);
  expect_sound(*planned, show);
  // 0.5 m is what the stage asks for: nothing changes.
  EXPECT_EQ(planned->plan.tracks, usual->plan.tracks);
  EXPECT_EQ(planned->plan.sections[0].notes, usual->plan.sections[0].notes);
}

TEST(PlanShow, RadiiThatTheGridCannotKeepAreNamed) {
  Show show = growing_show(70);
  show.performers[3].radius_m = 0.4;
  show.performers[7].radius_m = 0.35;
  const auto planned = plan_show(show, {growing_film()});
  ASSERT_TRUE(planned);
  EXPECT_THAT(planned->plan.sections[0].notes,
              testing::Contains("performers 4 and 8 (radius 0.4 m and 0.35 m) must keep 0.75 m, more than the 0.707 m "
                                "that walks on this grid keep by themselves: only people of the same radius take their "
                                "places, and some may have to wait"));
  for (Performer& performer : show.performers) performer.radius_m = 0.6;
  const auto refused = plan_show(show, {growing_film()});
  ASSERT_TRUE(refused);
  EXPECT_FALSE(refused->plan.valid);
  ASSERT_FALSE(refused->refusal.empty());
  EXPECT_EQ(refused->refusal.front(),
            "show.yaml:31:5: error: sections[0]: performers 1 and 2 (radius 0.6 m and 0.6 m) must keep 1.2 m, and "
            "neighbouring cells are 1 m apart (smaller radii or a pitch of at least 1.2 m)");
}

TEST(PlanShow, OneSlowPersonGetsASlowTrackAndTheOthersWalkAsUsual) {
  Show show = show_with(3);
  const auto at = [&](const char* cells) { return CellsSource{"c.csv", cells_in(show.stage.grid, cells), false}; };
  show.sections.push_back(section_of("one", at("A1:A3"), 1, 0, 4, 31));
  CellsSource two = at("A1:A1");
  for (const CellIndex cell : cells_in(show.stage.grid, "F2:F3")) two.cells.push_back(cell);
  show.sections.push_back(section_of("two", two, 13, 0, 4, 35));
  show.stage.max_speed_mps = 1.4;
  show.performers[2].max_speed_mps = 0.2;
  const auto planned = plan_show(show, {std::nullopt, std::nullopt});
  ASSERT_TRUE(planned);
  expect_sound(*planned, show);
  EXPECT_EQ(planned->plan.tracks[2].back().cell, show.stage.grid.index({0, 0}));
  EXPECT_TRUE(planned->plan.sections[0].notes.empty());
  for (Performer& performer : show.performers) performer.max_speed_mps = 0.2;
  const auto slow = plan_show(show, {std::nullopt, std::nullopt});
  ASSERT_TRUE(slow);
  EXPECT_FALSE(slow->plan.valid);
  EXPECT_THAT(slow->plan.sections[0].notes, testing::ElementsAre(testing::HasSubstr("as slowly as the slowest")));
}

TEST(PlanShow, FormationsThatTouchLeaveNoTimeToWalk) {
  Show show = show_with(1);
  const auto at = [&](const char* cell) { return CellsSource{"c.csv", cells_in(show.stage.grid, cell), true}; };
  show.sections.push_back(section_of("one", at("A1:A1"), 1, 0, 8, 31));
  show.sections.push_back(section_of("two", at("H1:H1"), 9, 0, 8, 35));
  show.stage.max_speed_mps = 1.4;
  const auto planned = plan_show(show, {std::nullopt, std::nullopt});
  ASSERT_TRUE(planned);
  EXPECT_THAT(planned->refusal,
              testing::ElementsAre("show.yaml:35:5: error: sections[1]: there is no time to walk between the section "
                                   "before and this one: performer 1 would walk 7.0 m from A1 to H1 at count 9 (start "
                                   "the section at count 19 or later, or end the one before 10 counts earlier)"));
}

TEST(PlanShow, ALittleTooFastIsNotGivenAsARatio) {
  Show show = show_with(1);
  const auto at = [&](const char* cell) { return CellsSource{"c.csv", cells_in(show.stage.grid, cell), true}; };
  show.sections.push_back(section_of("one", at("A1:A1"), 1, 0, 8, 31));
  show.sections.push_back(section_of("two", at("H1:H1"), 19, 0, 8, 35));
  show.stage.max_speed_mps = 1.38;
  const auto planned = plan_show(show, {std::nullopt, std::nullopt});
  ASSERT_TRUE(planned);
  ASSERT_EQ(planned->refusal.size(), 1U);
  EXPECT_THAT(planned->refusal[0], testing::HasSubstr("at 1.4 m/s, above the limit of 1.38 m/s (start"));
}

TEST(PlanShow, WhatGivesWayIsToldWithItsShareAndTheWorstFormation) {
  Show show = growing_show(70);
  show.sections[0].planner.model = PlannerModel::hierarchical;
  show.stage.max_speed_mps = 0.3;
  const auto planned = plan_show(show, {growing_film()});
  ASSERT_TRUE(planned);
  expect_sound(*planned, show);
  EXPECT_THAT(planned->plan.sections[0].notes,
              testing::Contains(testing::MatchesRegex(
                  "the drawing gives way: [0-9]+ of [0-9]+ places \\([0-9]+ %\\) in [0-9]+ formations are not reached "
                  "in time, most in growth/[0-9]+ \\([0-9]+ %\\), since nobody walks faster than 0.3 m/s")));
}

TEST(PlanShow, BlackFilmKeepsEverybodyInTheReserveOrIsAnInputError) {
  Show show = growing_show(30);
  const Film black = tests::film_of(10, [](int) { return Mask(40, 30); });
  const auto planned = plan_show(show, {black});
  ASSERT_TRUE(planned);
  expect_sound(*planned, show);
  show.stage.reserve.clear();
  const auto failed = plan_show(show, {black});
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().message,
            "show.yaml:31:5: error: sections[0]: 30 performers, but the largest picture of 'film.mp4' holds 0 and the "
            "reserve 0 (at least 30 more reserve cells, a larger floor, fit: area, or fewer performers)");
}

TEST(PlanShow, WhiteFilmOnePixelAndOnePersonArePlanned) {
  const Film white = tests::film_of(10, [](int) { return tests::mask_where(40, 30, [](int, int) { return true; }); });
  const Film pixel = tests::film_of(
      10, [](int) { return tests::mask_where(40, 30, [](int x, int y) { return x == 10 && y == 12; }); });
  for (const Film& film : {white, pixel}) {
    for (const int people : {1, 120}) {
      Show show = show_with(people);
      show.sections.push_back(section_of("film", video(), 1, 40, 0, 31));
      const auto planned = plan_show(show, {film});
      ASSERT_TRUE(planned) << planned.error().message;
      expect_sound(*planned, show);
    }
  }
}

TEST(PlanShow, FilmThatFollowsAtOnceTakesPeopleAsTheyStand) {
  Show show = growing_show(40);
  show.sections.push_back(section_of("again", video(), 125, 60, 0, 40));
  const auto planned = plan_show(show, {growing_film(), growing_film()});
  ASSERT_TRUE(planned) << planned.error().message;
  expect_sound(*planned, show);
}

TEST(PlanShow, ImageIsHeldAndPeopleStandStill) {
  Show show = show_with(60);
  show.sections.push_back(section_of("disc", ImageSource{"disc.png", {}}, 9, 0, 16, 31));
  const auto planned = plan_show(show, {tests::film_of(1, [](int) { return tests::disc(60, 60, 30, 30, 20); })});
  ASSERT_TRUE(planned) << planned.error().message;
  expect_sound(*planned, show);
  EXPECT_FALSE(planned->plan.formations.front().frame.has_value());
  for (const auto& track : planned->plan.tracks) {
    EXPECT_EQ(track.front().time, kStart);  // the opening form stands from the show's first instant
    EXPECT_EQ(track.back().time, show.tempo.at(25));
    EXPECT_EQ(track.front().cell, track.back().cell);
  }
}

TEST(PlanShow, ShortestDurationIsOneInWhichNobodyGivesWay) {
  Show show = growing_show(40);
  show.sections[0].planner.model = PlannerModel::hierarchical;
  const auto planned = plan_show(show, {growing_film()});
  ASSERT_TRUE(planned && planned->shortest.front().has_value());
  EXPECT_GT(planned->shortest.front()->counts, 1);
  EXPECT_THAT(planned->shortest.front()->limited_by, testing::HasSubstr(" m between count "));
}

TEST(PlanShow, StopsWhenToldTo) {
  const std::atomic<bool> stop = true;
  Progress progress;
  progress.stop = &stop;
  const auto planned = plan_show(growing_show(40), {growing_film()}, progress);
  ASSERT_FALSE(planned);
  EXPECT_EQ(planned.error().kind, ErrorKind::interrupted);
}

TEST(PlanShow, ShowWithoutPeopleIsAnInputError) {
  Show show = growing_show(0);
  const auto planned = plan_show(show, {growing_film()});
  ASSERT_FALSE(planned);
  EXPECT_EQ(planned.error().message, "show.yaml: error: performers: the show has nobody in it");
}

}  // namespace
}  // namespace footlight::planner
