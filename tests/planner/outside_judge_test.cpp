// SPDX-License-Identifier: Apache-2.0
#include "tests/support/outside_judge.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/check.hpp"
#include "planner/measure.hpp"
#include "planner/plan_show.hpp"
#include "planner/validate.hpp"
#include "tests/support/plan_builder.hpp"

namespace footlight::planner {
namespace {

using tests::number_in;
using tests::OutsideJudge;

/// Skips where the other judges are not.
class OutsideJudgeTest : public testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    static const std::string missing = OutsideJudge::missing();
    if (!missing.empty()) GTEST_SKIP() << missing;
  }
  OutsideJudge outside_;
};

/// A plan of a random kind of grid in which things go wrong now and then.
Plan some_plan(int seed, Rng& rng) {
  const auto kind = static_cast<GridKind>(seed % 3);
  const Grid grid = *Grid::make(kind, 9 + seed % 4, 8, 0.8 + 0.1 * (seed % 5));
  Plan plan = tests::random_plan(grid, 12 + rng.below(30), 5, seed % 2 == 0, rng);
  plan.stage.clearance_m = 0.15 + 0.1 * (seed % 4);
  plan.stage.max_speed_mps = 3;
  plan.sections[0].max_speed_mps = 0;
  return plan;
}

TEST_P(OutsideJudgeTest, CheckMarksAgreesAboutWhoComesTooClose) {
  Rng rng(static_cast<std::uint64_t>(GetParam()));
  Plan plan = some_plan(GetParam(), rng);
  if (plan.stage.grid.kind() == GridKind::square) plan.stage.blocked = tests::random_cells(plan.stage.grid, 4, rng);
  std::sort(plan.stage.blocked.begin(), plan.stage.blocked.end());
  outside_.write(plan);
  const std::string said = outside_.check_marks();
  const Verdict verdict = validate(plan);
  EXPECT_NEAR(verdict.min_clearance_m, number_in(said, "min_clearance_m").value(), 1e-6) << said;
  EXPECT_EQ(static_cast<double>(verdict.too_close), number_in(said, "too_close")) << said;
  EXPECT_EQ(static_cast<double>(verdict.violations), number_in(said, "wrong")) << said;
  EXPECT_NEAR(verdict.max_speed_mps, number_in(said, "max_speed_m_s").value(), 1e-6) << said;
}

TEST_P(OutsideJudgeTest, CheckMarksAgreesAboutTheToleratedLag) {
  Rng rng(static_cast<std::uint64_t>(GetParam()) + 100);
  Plan plan = tests::random_plan(*Grid::make(static_cast<GridKind>(GetParam() % 3), 12, 9, 1.0), 3, 5, false, rng);
  plan.stage.clearance_m = 0.1;
  plan.stage.max_speed_mps = 9;
  outside_.write(plan);
  double lag_s = 2.0;  // the whole length of a stretch
  for (int k = 0; k < 4; ++k) {
    lag_s = std::min(lag_s, tolerated_lag_s(plan, instant_at(2.0 * k), instant_at(2.0 * k + 2)));
  }
  if (lag_s > 0) {
    const std::string said = outside_.check_marks("--lag " + std::to_string(lag_s - 1e-6));
    EXPECT_EQ(number_in(said, "too_close_lag"), 0) << said;
  }
  if (lag_s < 2) {
    const std::string said = outside_.check_marks("--lag " + std::to_string(lag_s + 1e-4));
    EXPECT_GT(number_in(said, "too_close_lag").value(), 0) << said;
  }
}

/// Lists of cells, some of them by name: waits, marks on the way and conflicts that are left.
Plan planned_lists(int seed) {
  Rng rng(static_cast<std::uint64_t>(seed) + 300);
  Show show;
  show.file = "show.yaml";
  show.stage.grid = *Grid::make(static_cast<GridKind>(seed % 3), 12, 9, 1.0);
  show.stage.max_speed_mps = 1.4;
  for (int p = 0; p < 14; ++p) {
    Performer performer;
    performer.id = performer.name = std::to_string(p + 1);
    show.performers.push_back(performer);
  }
  for (int s = 0; s < 4; ++s) {
    Section section;
    section.name = "list" + std::to_string(s);
    CellsSource list;
    list.cells = tests::random_cells(show.stage.grid, 14, rng);
    list.assigned = s > 0 && s != seed % 4;
    section.from = list;
    section.start_count = 1 + s * (seed % 2 == 0 ? 60 : 24);
    section.hold_counts = 4;
    show.sections.push_back(section);
  }
  auto planned = plan_show(show, std::vector<std::optional<Film>>(4));
  FL_CHECK(planned.has_value());
  return std::move(planned->plan);
}

TEST_P(OutsideJudgeTest, CheckMarksMeasuresTheLagThatThePlanSays) {
  const Plan plan = planned_lists(GetParam());
  outside_.write(plan);
  double lag_s = 2;
  for (const TransitionFacts& facts : plan.transitions) lag_s = std::min(lag_s, facts.tolerated_lag_s);
  if (lag_s > 0) {
    const std::string said = outside_.check_marks("--lag " + std::to_string(lag_s - 1e-4));
    EXPECT_EQ(number_in(said, "too_close_lag"), 0) << said;
  }
  if (lag_s < 2) {
    const std::string said = outside_.check_marks("--lag " + std::to_string(lag_s + 1e-3));
    EXPECT_GT(number_in(said, "too_close_lag").value(), 0) << said;
  }
}

/// Blots that move over an odd number of pixels.
Film some_film(int frames, Rng& rng) {
  Film film{173, 131, 25, 0, 128, false, {}};
  for (int k = 0; k < frames; ++k) {
    Mask mask(film.width, film.height);
    const double cx = 30 + 8 * k + 20 * rng.uniform();
    const double cy = 60 + 30 * std::sin(k);
    const double radius = k == 3 ? 0 : 15 + 25 * rng.uniform();
    for (int y = 0; y < film.height; ++y) {
      for (int x = 0; x < film.width; ++x) {
        if (std::hypot(x - cx, y - cy) < radius) mask.set(x, y);
      }
    }
    film.frames.push_back(std::move(mask));
  }
  return film;
}

TEST_P(OutsideJudgeTest, ThetaDevAgreesAboutTheDrawing) {
  Rng rng(static_cast<std::uint64_t>(GetParam()) + 200);
  Plan plan = some_plan(GetParam(), rng);
  const Film film = some_film(14, rng);
  PlanSection& section = plan.sections[0];
  const double scale = 12 + rng.uniform();
  const double turn = GetParam() % 2 == 0 ? 0.0 : 0.2;
  section.film = FilmPlacement{
      "film", 0, 13, 13 / 8.0, film.width, film.height, 128, false, {scale, turn, 86.3, turn, -scale, 120.7}};
  if (GetParam() % 3 != 0) {  // also a film that begins before the section, with a reserve
    section.film->first_frame = 2;
    section.film->show_fps = 2.2;
    section.reserve = tests::random_cells(plan.stage.grid, 20, rng);
    std::sort(section.reserve.begin(), section.reserve.end());
  }
  outside_.write(plan);
  const std::string said = outside_.theta_dev(outside_.write(film), "all");
  const Measures found = measure(plan, {film}).sections.at(0);
  EXPECT_EQ(found.frames, number_in(said, "frames")) << said;
  EXPECT_GT(found.frames, 8);
  EXPECT_NEAR(found.theta_dev.value(), number_in(said, "theta_dev").value(), 1.1e-6) << said;
  EXPECT_NEAR(found.theta_dev_var.value(), number_in(said, "theta_dev_var").value(), 1.1e-8) << said;
  EXPECT_NEAR(found.theta_miss.value(), number_in(said, "theta_miss").value(), 1.1e-6) << said;
  EXPECT_NEAR(found.theta_iou.value(), number_in(said, "theta_iou").value(), 1.1e-6) << said;
}

INSTANTIATE_TEST_SUITE_P(RandomPlans, OutsideJudgeTest, testing::Range(0, 3));

}  // namespace
}  // namespace footlight::planner
