// SPDX-License-Identifier: Apache-2.0
//
// Obstacles that move: what the judge says of them, and where walks can be made beside them.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/motion.hpp"
#include "planner/motion/swept_discs.hpp"
#include "planner/validate.hpp"
#include "tests/planner/small_show.hpp"
#include "tests/support/plan_builder.hpp"

namespace footlight::planner {
namespace {

using tests::mark_at;
using tests::plan_of;
using Kind = Violation::Kind;

/// One person who walks five cells upstage in four seconds, and a section from 1 s to 3 s.
Plan walking_plan() {
  const Grid grid = *Grid::make(GridKind::square, 11, 11, 1.0);
  Plan plan = plan_of(grid, {{mark_at(0, grid, 5, 2), mark_at(4, grid, 5, 7)}});
  plan.stage.clearance_m = 0.5;
  plan.stage.max_speed_mps = 2;
  PlanSection section;
  section.name = "gate";
  section.start = instant_at(1);
  section.end = instant_at(3);
  plan.sections.push_back(section);
  return plan;
}

PlanObstacle resting(Point at, double radius_m) { return {radius_m, {{instant_at(0), at}}}; }

TEST(MovingObstacles, WhoComesTooNearToOneIsFound) {
  Plan plan = walking_plan();
  // On her way at 2 s: (0, 5); 0.2 m from its edge.
  plan.sections[0].obstacles = {resting({1.2, 5}, 1)};
  const Verdict verdict = validate(plan);
  ASSERT_EQ(verdict.violations, 1U);
  EXPECT_EQ(verdict.first[0].kind, Kind::into_obstacle);
  EXPECT_NEAR(verdict.first[0].value, 0.2, 1e-9);
  EXPECT_EQ(verdict.first[0].time, instant_at(2));
  EXPECT_EQ(verdict.first[0].text,
            "performer 1 comes 0.200 m near the moving obstacle 1 of section 'gate' from F3 to F8 at 2.000 s (at least "
            "0.250 m)");
}

TEST(MovingObstacles, KeepHalfOfTheClearanceOrTheBodysRadius) {
  Plan plan = walking_plan();
  plan.sections[0].obstacles = {resting({1.25, 5}, 1)};
  EXPECT_TRUE(validate(plan).valid());
  plan.radius_m[0] = 0.3;
  EXPECT_EQ(validate(plan).violations, 1U);
}

TEST(MovingObstacles, AreThereWhileTheirSectionLasts) {
  Plan plan = walking_plan();
  // She is beside it before 1 s and after 3 s alone.
  plan.sections[0].obstacles = {resting({0, 2}, 0.4), resting({0, 8}, 0.4)};
  EXPECT_TRUE(validate(plan).valid());
  plan.sections[0].start = kStart;
  plan.sections[0].end = instant_at(4);
  EXPECT_EQ(validate(plan).violations, 2U);
}

TEST(MovingObstacles, WhoStandsCanBeReached) {
  const Grid grid = *Grid::make(GridKind::square, 11, 11, 1.0);
  Plan plan = plan_of(grid, {{mark_at(0, grid, 5, 5), mark_at(10, grid, 5, 5)}});
  plan.stage.clearance_m = 0.5;
  PlanSection section;
  section.name = "car";
  section.end = instant_at(10);
  // Comes to 0.5 m at 6 s, and goes again.
  section.obstacles = {{1, {{instant_at(0), {-8, 5.5}}, {instant_at(6), {-1.5, 5.5}}, {instant_at(9), {-8, 5.5}}}}};
  plan.sections = {section};
  EXPECT_TRUE(validate(plan).valid());
  plan.sections[0].obstacles[0].radius_m = 1.4;
  const Verdict verdict = validate(plan);
  ASSERT_EQ(verdict.violations, 1U);
  EXPECT_EQ(verdict.first[0].time, instant_at(6));
  EXPECT_NEAR(verdict.first[0].value, 0.1, 1e-9);
}

TEST(MovingObstacles, AreJudgedAsSamplingThemFinelySays) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    const Grid grid = *Grid::make(GridKind::square, 12, 12, 1.0);
    Plan plan = tests::random_plan(grid, 1, 5, true, rng);
    plan.stage.clearance_m = 0.5;
    plan.stage.max_speed_mps = 100;
    PlanObstacle obstacle{0.3 + rng.uniform(), {}};
    double at_s = rng.uniform();
    for (int n = 0; n < 4; ++n, at_s += 0.3 + 3 * rng.uniform()) {
      obstacle.at.push_back({instant_at(at_s), {12 * rng.uniform() - 6, 12 * rng.uniform()}});
    }
    plan.sections[0].obstacles = {obstacle};
    double least_m = 1e9;
    for (double time_s = 0; time_s <= 8; time_s += 0.002) {
      std::size_t next = 0;
      while (next < 4 && to_seconds(obstacle.at[next].time - kStart) <= time_s) ++next;
      Point centre = next == 0 ? obstacle.at[0].centre : obstacle.at[3].centre;
      if (next > 0 && next < 4) {
        const double first_s = to_seconds(obstacle.at[next - 1].time - kStart);
        const double share = (time_s - first_s) / (to_seconds(obstacle.at[next].time - kStart) - first_s);
        centre = obstacle.at[next - 1].centre + share * (obstacle.at[next].centre - obstacle.at[next - 1].centre);
      }
      const Point person = position_at(grid, plan.tracks[0], instant_at(time_s));
      least_m = std::min(least_m, distance(person, centre) - obstacle.radius_m);
    }
    const Verdict verdict = validate(plan);
    if (least_m < 0.25) RC_ASSERT(!verdict.valid());
    if (least_m > 0.3) RC_ASSERT(verdict.valid());
    double found_m = 1e9;
    for (const Violation& one : verdict.first) found_m = std::min(found_m, one.value);
    if (!verdict.valid()) RC_ASSERT(std::abs(found_m - std::max(0.0, least_m)) < 0.03);
  }));
}

TEST(SweptDiscs, AreThePiecesOfTheWayWhileTheSectionLasts) {
  Show show = test::show_with(1);
  Section section = test::section_of("s", CellsSource{}, 5, 8, 4, 3);  // 2 s to 8 s
  auto motion = std::make_shared<Motion>();
  motion->obstacles = {{1.5, {{5, {0, 0}}, {9, {4, 0}}, {13, {4, 8}}}, {}}};
  section.motion = motion;
  show.sections = {section};
  EXPECT_TRUE(swept_discs(show, kStart, instant_at(1)).empty());
  EXPECT_TRUE(swept_discs(show, instant_at(9), instant_at(10)).empty());
  const auto pieces = swept_discs(show, instant_at(3), instant_at(5));
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_EQ(pieces[0].from, (Point{2, 0}));
  EXPECT_EQ(pieces[0].to, (Point{4, 0}));
  EXPECT_EQ(pieces[1].to, (Point{4, 4}));
  EXPECT_EQ(pieces[1].radius_m, 1.5);
  const auto held = swept_discs(show, instant_at(7), instant_at(20));
  ASSERT_EQ(held.size(), 1U);
  EXPECT_EQ(held[0].to, (Point{4, 8}));
}

TEST(Ways, BesideADiscNobodyStandsOrWalksWhereItIs) {
  Stage stage;
  stage.grid = *Grid::make(GridKind::square, 11, 11, 1.0);
  const Ways open(stage, 0.25);
  const Point low = stage.grid.centre(Cell{5, 2});
  const Point high = stage.grid.centre(Cell{5, 5});
  const Ways ways = open.beside({{low, high, 0.7}}, {{high, high + Point{0, 2}, 0.7}});
  EXPECT_TRUE(open.open());
  EXPECT_FALSE(ways.open());
  EXPECT_FALSE(ways.can_stand(stage.grid.index({5, 4})));
  EXPECT_FALSE(ways.can_stand(stage.grid.index({5, 7})));  // where it goes after
  EXPECT_TRUE(ways.can_stand(stage.grid.index({6, 4})));   // 1 m from its middle, 0.3 m from its edge
  EXPECT_FALSE(ways.straight(stage.grid.centre(Cell{3, 4}), stage.grid.centre(Cell{7, 4})));
  EXPECT_TRUE(ways.straight(stage.grid.centre(Cell{3, 7}), stage.grid.centre(Cell{7, 7})));  // it is not there yet
  EXPECT_TRUE(ways.straight(stage.grid.centre(Cell{4, 1}), stage.grid.centre(Cell{4, 8})));
}

}  // namespace
}  // namespace footlight::planner
