// SPDX-License-Identifier: Apache-2.0
#include "planner/measure.hpp"

#include <atomic>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "planner/validate.hpp"
#include "tests/support/plan_builder.hpp"

namespace footlight::planner {
namespace {

using tests::mark_at;
using tests::plan_of;

/// Four by four squares of a metre, ten pixels each: A1 is the lower left one.
Grid floor4() { return *Grid::make(GridKind::square, 4, 4, 1.0); }

PlanSection section_with_film(double end_s, double fps, int frames) {
  PlanSection section{"film", kStart, instant_at(end_s), 1.4, {}, {}, {}};
  section.film = FilmPlacement{"film", 0, frames - 1, fps, 40, 40, 128, false, {10, 0, 20, 0, -10, 40}};
  return section;
}

Film film_of(std::vector<Mask> frames) { return {40, 40, 25, 0, 128, false, std::move(frames)}; }

/// The picture is the left `columns` pixels.
Mask left_part(int columns) {
  Mask mask(40, 40);
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < columns; ++x) mask.set(x, y);
  }
  return mask;
}

/// Somebody on every cell of column `column` who stays.
Plan standing_column(int column, double end_s) {
  std::vector<std::vector<Mark>> tracks;
  for (int row = 0; row < 4; ++row) {
    tracks.push_back({mark_at(0, floor4(), column, row), mark_at(end_s, floor4(), column, row)});
  }
  return plan_of(floor4(), tracks);
}

TEST(Measure, IsZeroForADrawingThatFillsThePicture) {
  Plan plan = standing_column(0, 1);
  plan.sections = {section_with_film(1, 1, 2)};
  const ShowMeasures found = measure(plan, {film_of({left_part(10), left_part(10)})});
  EXPECT_EQ(found.sections.at(0).frames, 2);
  EXPECT_EQ(found.sections[0].theta_dev, 0.0);
  EXPECT_EQ(found.sections[0].theta_dev_var, 0.0);
  EXPECT_EQ(found.sections[0].theta_miss, 0.0);
  EXPECT_EQ(found.sections[0].theta_iou, 0.0);
}

TEST(Measure, CountsTheShareOfEachSquareOutsideOfThePicture) {
  Plan plan = standing_column(0, 1);
  plan.sections = {section_with_film(1, 1, 2)};
  // First frame: half of each square. Second: all of it, and as much again that nobody covers.
  const Measures found = measure(plan, {film_of({left_part(5), left_part(20)})}).show;
  EXPECT_DOUBLE_EQ(found.theta_dev.value(), 0.25);
  EXPECT_DOUBLE_EQ(found.theta_dev_var.value(), 0.0625) << "population variance of 0.5 and 0";
  EXPECT_DOUBLE_EQ(found.theta_miss.value(), 0.25);
  EXPECT_DOUBLE_EQ(found.theta_iou.value(), 0.5);
}

TEST(Measure, TakesFractionsOfPixels) {
  const Grid grid = floor4();
  // At 0.5 s the walk from A1 to B1 is 4.55 pixels on its way when 10 pixels take 1.1 s.
  Plan plan = plan_of(grid, {{mark_at(0, grid, 0, 0), mark_at(1.1, grid, 1, 0)}});
  PlanSection section = section_with_film(1.1, 2, 3);
  plan.sections = {section};
  const Measures found = measure(plan, {film_of({left_part(10), left_part(10), left_part(10)})}).show;
  const double at_half = 0.5 / 1.1;
  const double at_one = 1.0 / 1.1;
  EXPECT_EQ(found.frames, 3);
  EXPECT_NEAR(found.theta_dev.value(), (0 + at_half + at_one) / 3, 1e-12);
}

TEST(Measure, LeavesPeopleOutWhoStandInReserveAtBothEndsOfAStretch) {
  const Grid grid = floor4();
  Plan plan = plan_of(grid, {{mark_at(0, grid, 0, 0), mark_at(1, grid, 0, 0), mark_at(2, grid, 0, 0)},
                             {mark_at(0, grid, 3, 0), mark_at(1, grid, 3, 0), mark_at(2, grid, 2, 0)}});
  plan.sections = {section_with_film(2, 1, 3)};
  plan.sections[0].reserve = {grid.index({3, 0})};
  const auto judged = [&](std::vector<Mask> frames) { return measure(plan, {film_of(std::move(frames))}).show; };
  // At 0 s the second is in reserve; from 1 s on she walks out of it and is in the picture.
  EXPECT_DOUBLE_EQ(judged({left_part(10)}).theta_dev.value(), 0.0);
  EXPECT_DOUBLE_EQ(judged({left_part(10), left_part(10)}).theta_dev.value(), 0.25);
}

TEST(Measure, HasNoThetaWhenEverybodyIsInReserve) {
  Plan plan = standing_column(0, 1);
  plan.sections = {section_with_film(1, 1, 2)};
  for (int row = 0; row < 4; ++row) plan.sections[0].reserve.push_back(plan.stage.grid.index({0, row}));
  const Measures found = measure(plan, {film_of({left_part(10), left_part(0)})}).show;
  EXPECT_EQ(found.frames, 0);
  EXPECT_FALSE(found.theta_dev.has_value());
  EXPECT_FALSE(found.theta_dev_var.has_value());
  EXPECT_EQ(found.theta_miss, 1.0) << "of the one frame that has a picture";
  EXPECT_EQ(found.theta_iou, 1.0);
}

TEST(Measure, JudgesTheFramesThatFallIntoTheSectionOnly) {
  Plan plan = standing_column(0, 1);
  plan.sections = {section_with_film(1, 2, 3)};
  plan.sections[0].film->first_frame = 1;
  Film film = film_of({left_part(0), left_part(10), left_part(10), left_part(10), left_part(0), left_part(0)});
  Measures found = measure(plan, {film}).show;
  EXPECT_EQ(found.frames, 3);
  EXPECT_EQ(found.theta_dev, 0.0);
  // The same film whose first decoded frame has number 1.
  film.frames.erase(film.frames.begin());
  film.first_frame = 1;
  found = measure(plan, {film}).show;
  EXPECT_EQ(found.frames, 3);
  EXPECT_EQ(found.theta_dev, 0.0);
}

TEST(Measure, JudgesNothingAfterTheFilmsLastFrame) {
  Plan plan = standing_column(0, 9);
  plan.sections = {section_with_film(9, 1, 2)};
  EXPECT_EQ(measure(plan, {film_of({left_part(10), left_part(10)})}).show.frames, 2);
}

TEST(Measure, JudgesAnImageOnceAtTheSectionsStart) {
  Plan plan = standing_column(0, 4);
  plan.sections = {section_with_film(4, 0, 1)};
  const Measures found = measure(plan, {film_of({left_part(5)})}).show;
  EXPECT_EQ(found.frames, 1);
  EXPECT_DOUBLE_EQ(found.theta_dev.value(), 0.5);
}

TEST(Measure, HasNoThetaWithoutAFilm) {
  Plan plan = standing_column(0, 1);
  plan.sections = {{"cells", kStart, instant_at(1), 1.4, {}, {}, {}}};
  const Measures found = measure(plan, {std::nullopt}).sections.at(0);
  EXPECT_EQ(found.frames, 0);
  EXPECT_FALSE(found.theta_dev || found.theta_dev_var || found.theta_miss || found.theta_iou);
}

TEST(Measure, WeighsEachFrameOfAShowTheSame) {
  Plan plan = standing_column(0, 4);
  plan.sections = {section_with_film(1, 1, 2), section_with_film(4, 1, 1)};
  plan.sections[1].start = instant_at(2);
  const ShowMeasures found = measure(plan, {film_of({left_part(10), left_part(10)}), film_of({left_part(4)})});
  EXPECT_DOUBLE_EQ(found.sections[0].theta_dev.value(), 0.0);
  EXPECT_DOUBLE_EQ(found.sections[1].theta_dev.value(), 0.6);
  EXPECT_DOUBLE_EQ(found.show.theta_dev.value(), 0.2);
  EXPECT_NEAR(found.show.theta_dev_var.value(), 0.08, 1e-12);
  EXPECT_EQ(found.show.frames, 3);
}

TEST(Measure, GivesTheWalkBetweenSectionsToTheLaterOne) {
  const Grid grid = floor4();
  Plan plan =
      plan_of(grid, {{mark_at(0, grid, 0, 0), mark_at(2, grid, 1, 0), mark_at(3, grid, 3, 0), mark_at(9, grid, 3, 1)},
                     {mark_at(0, grid, 0, 3), mark_at(9, grid, 0, 3)}});
  plan.sections = {{"one", kStart, instant_at(2), 1.4, {}, {}, {}},
                   {"two", instant_at(3), instant_at(9), 1.4, {}, {}, {}}};
  Formation formation;
  formation.section = SectionIndex(1);
  plan.formations = {formation, formation};
  const ShowMeasures found = measure(plan, {std::nullopt, std::nullopt});
  EXPECT_DOUBLE_EQ(found.sections[0].total_distance_m, 1.0);
  EXPECT_DOUBLE_EQ(found.sections[0].max_speed_m_s, 0.5);
  EXPECT_DOUBLE_EQ(found.sections[1].total_distance_m, 3.0);
  EXPECT_DOUBLE_EQ(found.sections[1].max_speed_m_s, 2.0);
  EXPECT_DOUBLE_EQ(found.show.total_distance_m, 4.0);
  EXPECT_DOUBLE_EQ(found.show.longest_distance_m, 4.0);
  EXPECT_DOUBLE_EQ(found.show.min_clearance_m, 3.0);
  EXPECT_EQ(found.show.formations, 2);
  EXPECT_EQ(found.sections[0].formations, 0);
  EXPECT_EQ(found.sections[1].formations, 2);
}

TEST(Measure, NamesTheNearestTwoAndWhen) {
  const Grid grid = floor4();
  Plan plan = plan_of(grid, {{mark_at(0, grid, 0, 0), mark_at(2, grid, 0, 0), mark_at(4, grid, 3, 0)},
                             {mark_at(0, grid, 3, 3), mark_at(4, grid, 3, 3)},
                             {mark_at(0, grid, 3, 2), mark_at(2, grid, 3, 1), mark_at(4, grid, 3, 1)}});
  plan.sections = {{"one", kStart, instant_at(2), 1.4, {}, {}, {}},
                   {"two", instant_at(2), instant_at(4), 1.4, {}, {}, {}}};
  const ShowMeasures found = measure(plan, {std::nullopt, std::nullopt});
  EXPECT_EQ(found.sections[0].closest_a, PerformerIndex(1));
  EXPECT_EQ(found.sections[0].closest_b, PerformerIndex(2));
  EXPECT_EQ(found.sections[0].closest_at, kStart);
  EXPECT_EQ(found.sections[1].closest_a, PerformerIndex(0));
  EXPECT_EQ(found.sections[1].closest_b, PerformerIndex(2));
  EXPECT_EQ(found.sections[1].closest_at, instant_at(4));
  EXPECT_EQ(found.show.closest_at, kStart) << "the earlier of two equals";
}

TEST(Measure, TellsHowUnequalTheWaysAre) {
  const Grid grid = floor4();
  // 0, 1, 2 and 3 metres in half a minute.
  std::vector<std::vector<Mark>> tracks;
  for (int row = 0; row < 4; ++row) tracks.push_back({mark_at(0, grid, 0, row), mark_at(30, grid, row, row)});
  Plan plan = plan_of(grid, tracks);
  plan.sections = {{"all", kStart, instant_at(30), 1.4, {}, {}, {}}};
  const Measures found = measure(plan, {std::nullopt}).show;
  EXPECT_DOUBLE_EQ(found.median_distance_m, 1.5);
  EXPECT_DOUBLE_EQ(found.longest_distance_m, 3);
  // Mean absolute difference 20 / 16 over twice the mean of 1.5.
  EXPECT_DOUBLE_EQ(found.distance_gini, 20.0 / 16 / 3);
  EXPECT_EQ(found.arrivals, 3U);
  EXPECT_DOUBLE_EQ(found.marks_per_minute, 1.5);
  plan.tracks = {plan.tracks[0], plan.tracks[1]};
  plan.performers.resize(2);
  plan.radius_m.resize(2);
  EXPECT_DOUBLE_EQ(measure(plan, {std::nullopt}).show.distance_gini, 0.5) << "one of two walks all there is";
}

TEST(Measure, NobodyWhoStandsStillIsUnequal) {
  const Measures found = measure(standing_column(0, 1), {}).show;
  EXPECT_EQ(found.distance_gini, 0.0);
  EXPECT_EQ(found.median_distance_m, 0.0);
  EXPECT_EQ(found.marks_per_minute, 0.0);
  EXPECT_EQ(found.direction_changes, 0U);
}

TEST(Measure, CountsTurnsOfMoreThanThirtyDegreesAcrossWaits) {
  const Grid grid = floor4();
  const auto turns = [&](std::vector<Mark> track) {
    Plan plan = plan_of(grid, {std::move(track)});
    return measure(plan, {}).show.direction_changes;
  };
  EXPECT_EQ(turns({mark_at(0, grid, 0, 0), mark_at(1, grid, 1, 0), mark_at(2, grid, 3, 0)}), 0U);
  EXPECT_EQ(turns({mark_at(0, grid, 0, 0), mark_at(1, grid, 1, 0), mark_at(2, grid, 3, 1)}), 0U) << "26.6 degrees";
  EXPECT_EQ(turns({mark_at(0, grid, 0, 0), mark_at(1, grid, 1, 0), mark_at(2, grid, 2, 1)}), 1U) << "45 degrees";
  EXPECT_EQ(turns({mark_at(0, grid, 0, 0), mark_at(1, grid, 1, 0), mark_at(2, grid, 1, 0), mark_at(3, grid, 0, 0)}),
            1U);
}

TEST(Measure, ATurnAtASectionsStartIsTheLaterSections) {
  const Grid grid = floor4();
  Plan plan = plan_of(grid, {{mark_at(0, grid, 0, 0), mark_at(2, grid, 1, 0), mark_at(4, grid, 1, 2)}});
  plan.sections = {{"one", kStart, instant_at(2), 1.4, {}, {}, {}},
                   {"two", instant_at(2), instant_at(4), 1.4, {}, {}, {}}};
  const ShowMeasures found = measure(plan, {std::nullopt, std::nullopt});
  EXPECT_EQ(found.sections[0].direction_changes, 0U);
  EXPECT_EQ(found.sections[1].direction_changes, 1U);
}

TEST(Measure, ToleratedLagIsMeasuredWhateverThePlanSays) {
  Rng rng(7);
  Plan plan = tests::random_plan(floor4(), 3, 4, false, rng);
  for (int k = 0; k < 3; ++k) {
    TransitionFacts facts;
    facts.start = instant_at(2 * k);
    facts.end = instant_at(2 * k + 2);
    facts.tolerated_lag_s = 1.75;
    plan.transitions.push_back(facts);
  }
  const auto lag_s = measure_lag(plan);
  ASSERT_EQ(lag_s.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(lag_s[k], tolerated_lag_s(plan, plan.transitions[k].start, plan.transitions[k].end));
  }
}

TEST(Measure, TellsItsProgressAndStops) {
  Plan plan = standing_column(0, 200);
  plan.sections = {section_with_film(200, 1, 200)};
  const Film film = film_of(std::vector<Mask>(200, left_part(10)));
  std::vector<double> shares;
  std::atomic<bool> stop{false};
  Progress progress;
  progress.stop = &stop;
  progress.report = [&](std::string_view stage, double share) {
    EXPECT_EQ(stage, "measure");
    shares.push_back(share);
    stop = shares.size() == 2;
  };
  const ShowMeasures found = measure(plan, {film}, progress);
  EXPECT_EQ(shares.size(), 2U);
  EXPECT_LT(shares[0], shares[1]);
  EXPECT_LT(found.show.frames, 200);
}

}  // namespace
}  // namespace footlight::planner
