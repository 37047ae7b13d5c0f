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
