// SPDX-License-Identifier: Apache-2.0
#include "app/show_series.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "planner/measure.hpp"
#include "planner/validate.hpp"
#include "tests/support/films.hpp"
#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

using tests::mark_at;

Plan plan_with_section(const Grid& grid, std::vector<std::vector<Mark>> tracks, double end_s) {
  Plan plan = tests::plan_of(grid, std::move(tracks));
  plan.sections.push_back({"all", kStart, instant_at(end_s), 100, {}, {}, {}});
  return plan;
}

TEST(MutualInformation, IsOfXusEquation11) {
  EXPECT_EQ(mutual_information_bits({}), 0);
  EXPECT_DOUBLE_EQ(mutual_information_bits({{0, 0}, {0, 1}, {1, 0}, {1, 1}}), 0) << "one says nothing of the other";
  EXPECT_DOUBLE_EQ(mutual_information_bits({{0, 3}, {1, 2}, {2, 1}, {3, 0}}), 2) << "one says the other: log2 4";
  // p(0,0) = 1/2, p(0,1) = 1/4, p(1,1) = 1/4; by hand.
  const double expected = 0.5 * std::log2(0.5 / (0.75 * 0.5)) + 0.25 * std::log2(0.25 / (0.75 * 0.5)) +
                          0.25 * std::log2(0.25 / (0.25 * 0.5));
  EXPECT_NEAR(mutual_information_bits({{0, 0}, {0, 0}, {0, 1}, {1, 1}}), expected, 1e-12);
}

TEST(CrowdSeries, WhoAllWalkOneWayTellNothingOfTheirPlace) {
  const Grid grid = *Grid::make(GridKind::square, 20, 10, 1);
  std::vector<std::vector<Mark>> one_way;
  std::vector<std::vector<Mark>> apart;
  for (int row = 0; row < 10; row += 2) {
    for (const int column : {2, 17}) {
      one_way.push_back({mark_at(0, grid, column, row), mark_at(4, grid, column, row + 1)});
      const int to = column == 2 ? 1 : 18;
      apart.push_back({mark_at(0, grid, column, row), mark_at(4, grid, to, row)});
    }
  }
  const CrowdSeries calm = crowd_series(plan_with_section(grid, one_way, 4), 1);
  ASSERT_EQ(calm.time_s.size(), 5U);
  EXPECT_DOUBLE_EQ(calm.information[1], 0);
  EXPECT_TRUE(std::isnan(calm.information[4])) << "nobody walks any more";
  EXPECT_NEAR(calm.sigma_effort_m[2], 0, 1e-12) << "everybody as far as the others";
  EXPECT_NEAR(calm.sigma_nearest_m[0], 0, 1e-12);
  const CrowdSeries torn = crowd_series(plan_with_section(grid, apart, 4), 1);
  // Left of the middle to the left: x says the direction (1 bit), y nothing.
  EXPECT_DOUBLE_EQ(torn.information[1], 0.5);
}

TEST(CrowdSeries, PlacesTellHowFastPeopleWalkWhereOneSideHurries) {
  const Grid grid = *Grid::make(GridKind::square, 20, 10, 1);
  std::vector<std::vector<Mark>> even;
  std::vector<std::vector<Mark>> hurried;
  for (int row = 0; row < 10; row += 2) {
    for (const int column : {2, 15}) {
      even.push_back({mark_at(0, grid, column, row), mark_at(4, grid, column + 1, row)});
      hurried.push_back({mark_at(0, grid, column, row), mark_at(4, grid, column == 2 ? 3 : 19, row)});
    }
  }
  EXPECT_DOUBLE_EQ(crowd_series(plan_with_section(grid, even, 4), 1).pace_information[1], 0);
  const CrowdSeries series = crowd_series(plan_with_section(grid, hurried, 4), 1);
  EXPECT_DOUBLE_EQ(series.pace_information[1], 0.5) << "x says the speed (1 bit), y nothing";
  EXPECT_DOUBLE_EQ(series.information[1], 0) << "all go the same way";
  EXPECT_TRUE(std::isnan(series.pace_information[4]));
}

TEST(CrowdSeries, SigmasAreOfXusEquations24And26) {
  const Grid grid = *Grid::make(GridKind::square, 20, 10, 1);
  // Three people: nearest 1, 1 and 6 m; ways of 0, 0 and 2 m after two of four seconds.
  Plan plan = plan_with_section(grid,
                                {{mark_at(0, grid, 0, 0), mark_at(4, grid, 0, 0)},
                                 {mark_at(0, grid, 1, 0), mark_at(4, grid, 1, 0)},
                                 {mark_at(0, grid, 7, 0), mark_at(4, grid, 11, 0)}},
                                4);
  plan.formations.push_back({"all/1", SectionIndex(0), 1, kStart, {}, {}, 3});
  const CrowdSeries series = crowd_series(plan, 2);
  const auto sigma = [](double a, double b, double c) {
    const double mean = (a + b + c) / 3;
    return std::sqrt(((a - mean) * (a - mean) + (b - mean) * (b - mean) + (c - mean) * (c - mean)) / 3);
  };
  EXPECT_NEAR(series.sigma_nearest_m[0], sigma(1, 1, 6), 1e-12);
  EXPECT_NEAR(series.sigma_nearest_m[1], sigma(1, 1, 8), 1e-12);
  EXPECT_NEAR(series.sigma_effort_m[1], sigma(0, 0, 2), 1e-12);
}

TEST(ClearanceSeries, ItsLeastIsTheJudgesLeast) {
  Rng rng(5);
  const Grid grid = *Grid::make(GridKind::square, 16, 12, 1);
  const Plan plan = tests::random_plan(grid, 40, 6, true, rng);
  const ClearanceSeries series = clearance_series(plan, 1);
  const auto least = std::ranges::min_element(series.least_m);
  const planner::Verdict verdict = planner::validate(plan);
  EXPECT_DOUBLE_EQ(*least, verdict.min_clearance_m);
  const auto k = static_cast<std::size_t>(least - series.least_m.begin());
  EXPECT_EQ(series.a[k], verdict.closest_a);
  EXPECT_GE(series.at_s[k], series.time_s[k]);
  EXPECT_LE(series.at_s[k], series.time_s[k] + 1);
}

TEST(DrawingSeries, ItsMeanIsWhatMeasureSays) {
  tests::SmallShow cast = tests::random_show(20, 10, 20, 1, 3, 5);
  const Film film = tests::film_of(7, [](int f) { return tests::disc(40, 20, 10 + 3 * f, 10, 6); });
  FilmPlacement placement;
  placement.last_frame = 6;
  placement.show_fps = 1;
  placement.width = 40;
  placement.height = 20;
  placement.stage_to_frame = {2, 0, 20, 0, -2, 20};
  cast.plan.sections[0].film = placement;
  const Films films{film};
  const DrawingSeries series = drawing_series(cast.plan, films);
  ASSERT_EQ(series.time_s.size(), 7U);
  EXPECT_EQ(series.time_s[3], 3);
  const auto measured = planner::measure(cast.plan, films).show;
  double dev = 0;
  double miss = 0;
  for (std::size_t i = 0; i < 7; ++i) {
    dev += series.dev[i] / 7;
    miss += series.miss[i] / 7;
  }
  EXPECT_NEAR(dev, measured.theta_dev.value(), 1e-9);
  EXPECT_NEAR(miss, measured.theta_miss.value(), 1e-9);
}

TEST(DrawingSeries, OfAnImageLastsAsLongAsItsSection) {
  tests::SmallShow cast = tests::random_show(20, 10, 20, 1, 3, 5);
  FilmPlacement placement;
  placement.width = 40;
  placement.height = 20;
  placement.stage_to_frame = {2, 0, 20, 0, -2, 20};
  cast.plan.sections[0].film = placement;
  const DrawingSeries series =
      drawing_series(cast.plan, {tests::film_of(1, [](int) { return tests::disc(40, 20, 20, 10, 6); })});
  ASSERT_EQ(series.time_s.size(), 2U);
  EXPECT_EQ(series.time_s[0], to_seconds(cast.plan.sections[0].start));
  EXPECT_EQ(series.time_s[1], to_seconds(cast.plan.sections[0].end));
  EXPECT_EQ(series.miss[0], series.miss[1]);
  EXPECT_GT(series.miss[0], 0);
}

TEST(WayFigures, AddUpToWhatMeasureSays) {
  Rng rng(5);
  const Grid grid = *Grid::make(GridKind::square, 16, 12, 1);
  const Plan plan = tests::random_plan(grid, 10, 5, true, rng);
  const WayFigures ways = way_figures(plan);
  const auto measured = planner::measure(plan, {std::nullopt}).show;
  double all = 0;
  for (const double way : ways.walked_m) all += way;
  EXPECT_NEAR(all, measured.total_distance_m, 1e-6);
  EXPECT_DOUBLE_EQ(*std::ranges::max_element(ways.fastest_mps), measured.max_speed_m_s);
}

}  // namespace
}  // namespace footlight::app
