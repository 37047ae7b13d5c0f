// SPDX-License-Identifier: Apache-2.0
#include "planner/validate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "tests/support/plan_builder.hpp"

namespace footlight::planner {
namespace {

using tests::mark_at;
using tests::plan_of;
using Kind = Violation::Kind;

Grid grid_of(GridKind kind, int columns, int rows, double pitch_m = 1.0) {
  return *Grid::make(kind, columns, rows, pitch_m);
}
Grid squares() { return grid_of(GridKind::square, 10, 8); }

/// Two people three cells apart who each walk one cell upstage in two seconds.
Plan calm_plan() {
  const Grid grid = squares();
  return plan_of(grid,
                 {{mark_at(0, grid, 1, 1), mark_at(2, grid, 1, 2)}, {mark_at(0, grid, 4, 1), mark_at(2, grid, 4, 2)}});
}

std::vector<Kind> kinds_of(const Verdict& verdict) {
  std::vector<Kind> out;
  for (const Violation& violation : verdict.first) out.push_back(violation.kind);
  return out;
}

using testing::ElementsAre;

TEST(Validate, FindsNothingWrongWithTwoPeopleWhoKeepApart) {
  const Verdict verdict = validate(calm_plan());
  EXPECT_TRUE(verdict.valid());
  EXPECT_TRUE(verdict.first.empty());
  EXPECT_DOUBLE_EQ(verdict.min_clearance_m, 3.0);
  EXPECT_DOUBLE_EQ(verdict.max_speed_mps, 0.5);
  EXPECT_EQ(verdict.closest_a, PerformerIndex(0));
  EXPECT_EQ(verdict.closest_b, PerformerIndex(1));
}

TEST(Validate, OfAStretchSaysNothingOfWhatLiesOutsideOfIt) {
  const Grid grid = squares();
  // Two pass through each other between 2 s and 4 s; the first is on the other's cell at 6 s.
  const Plan plan =
      plan_of(grid, {{mark_at(0, grid, 1, 1), mark_at(2, grid, 1, 1), mark_at(4, grid, 3, 1), mark_at(6, grid, 1, 1)},
                     {mark_at(0, grid, 3, 1), mark_at(2, grid, 3, 1), mark_at(4, grid, 1, 1), mark_at(6, grid, 1, 1)}});
  EXPECT_TRUE(validate(plan, instant_at(0), instant_at(2)).valid());
  EXPECT_THAT(kinds_of(validate(plan, instant_at(0), instant_at(3))), ElementsAre(Kind::too_close));
  EXPECT_THAT(kinds_of(validate(plan, instant_at(3.5), instant_at(4))), ElementsAre());
  EXPECT_THAT(kinds_of(validate(plan, instant_at(5.9), instant_at(6))), ElementsAre(Kind::same_cell, Kind::too_close));
}

TEST(Validate, OfAStretchAsksEverybodyToBeThereAllOfIt) {
  Plan plan = calm_plan();
  plan.tracks[0].erase(plan.tracks[0].begin());
  EXPECT_THAT(kinds_of(validate(plan, instant_at(0), instant_at(2))), ElementsAre(Kind::times));
  EXPECT_TRUE(validate(plan, instant_at(2), instant_at(2)).valid());
}

TEST(Validate, AcceptsAnEmptyPlan) {
  const Verdict verdict = validate(plan_of(squares(), {}));
  EXPECT_TRUE(verdict.valid());
  EXPECT_EQ(verdict.min_clearance_m, std::numeric_limits<double>::infinity());
}

TEST(Validate, HasNoClearanceForASoloist) {
  Plan plan = calm_plan();
  plan.tracks.pop_back();
  plan.performers.pop_back();
  plan.radius_m.pop_back();
  plan.max_speed_mps.pop_back();
  EXPECT_EQ(validate(plan).min_clearance_m, std::numeric_limits<double>::infinity());
  EXPECT_TRUE(validate(plan).valid());
}

TEST(Validate, FindsMarksInWrongOrderOfTime) {
  Plan plan = calm_plan();
  const Grid& grid = plan.stage.grid;
  plan.tracks[0] = {mark_at(0, grid, 1, 1), mark_at(2, grid, 1, 3), mark_at(1, grid, 1, 2), mark_at(2, grid, 1, 3)};
  const Verdict verdict = validate(plan);
  ASSERT_THAT(kinds_of(verdict), ElementsAre(Kind::times));
  EXPECT_EQ(verdict.first[0].text, "performer 1 has its mark at 1.000 s after the one at 2.000 s");
}

TEST(Validate, FindsTwoMarksAtOneInstant) {
  Plan plan = calm_plan();
  plan.tracks[0].push_back(plan.tracks[0].back());
  EXPECT_THAT(kinds_of(validate(plan)), ElementsAre(Kind::times));
}

TEST(Validate, FindsSomebodyWhoIsNotThereFromTheFirstToTheLastInstant) {
  Plan plan = calm_plan();
  plan.tracks[1].pop_back();
  const Verdict verdict = validate(plan);
  ASSERT_THAT(kinds_of(verdict), ElementsAre(Kind::times));
  EXPECT_EQ(verdict.first[0].text,
            "performer 2 has marks from 0.000 s to 0.000 s, the show is from 0.000 s to 2.000 s");
  EXPECT_EQ(verdict.first[0].a, PerformerIndex(1));
}

TEST(Validate, FindsSomebodyWithoutAMark) {
  Plan plan = calm_plan();
  plan.tracks[1].clear();
  const Verdict verdict = validate(plan);
  ASSERT_THAT(kinds_of(verdict), ElementsAre(Kind::times));
  EXPECT_EQ(verdict.first[0].text, "performer 2 has no mark");
}

TEST(Validate, FindsACellOffTheGrid) {
  Plan plan = calm_plan();
  plan.tracks[1].push_back({instant_at(3), CellIndex::of(80)});
  plan.tracks[0].push_back(mark_at(3, plan.stage.grid, 1, 2));
  const Verdict verdict = validate(plan);
  ASSERT_THAT(kinds_of(verdict), ElementsAre(Kind::off_grid));
  EXPECT_EQ(verdict.first[0].text, "performer 2 stands off the grid at 3.000 s (cell number 80 of 80)");
  plan.tracks[1].back().cell = CellIndex::of(79);
  EXPECT_THAT(kinds_of(validate(plan)), ElementsAre(Kind::too_fast)) << "the last cell is on the grid, but far away";
}

TEST(Validate, FindsSomebodyOnABlockedCell) {
  Plan plan = calm_plan();
  plan.stage.blocked = {plan.stage.grid.index({4, 2})};
  plan.stage.clearance_m = 0.5;
  const Verdict verdict = validate(plan);
  ASSERT_THAT(kinds_of(verdict), ElementsAre(Kind::into_blocked, Kind::blocked_cell));
  EXPECT_EQ(verdict.first[1].text, "performer 2 stands on the blocked cell E3 at 2.000 s");
  EXPECT_EQ(
      verdict.first[0].text,
      "performer 2 comes 0.000 m near the blocked cell E3 on the way from E2 to E3 at 0.000 s (at least 0.250 m)");
}

TEST(Validate, LetsPeopleStandBesideABlockedCell) {
  Plan plan = calm_plan();
  plan.stage.blocked = {plan.stage.grid.index({5, 2})};
  EXPECT_TRUE(validate(plan).valid());
}

TEST(Validate, KeepsAWideBodyOffABlockedCell) {
  Plan plan = calm_plan();
  plan.stage.blocked = {plan.stage.grid.index({5, 2})};
  plan.radius_m.assign(plan.performers.size(), 0.0);
  EXPECT_TRUE(validate(plan).valid());
  plan.radius_m[1] = 0.6;
  const Verdict verdict = validate(plan);
  ASSERT_FALSE(verdict.valid());
  EXPECT_EQ(verdict.first.front().kind, Kind::into_blocked);
  EXPECT_DOUBLE_EQ(verdict.first.front().limit, 0.6);
}

TEST(Validate, FindsAWalkPastTheCornerOfABlockedCell) {
  const Grid grid = squares();
  Plan plan = plan_of(grid, {{mark_at(0, grid, 0, 0), mark_at(9, grid, 2, 1)}});
  // The corner of B2 at (-3, 1) lies 1 / (2 sqrt(5)) m from the line through (-4.5, 0.5) and (-2.5, 1.5).
  plan.stage.blocked = {grid.index({1, 1})};
  plan.stage.clearance_m = 0.5;
  EXPECT_THAT(kinds_of(validate(plan)), ElementsAre(Kind::into_blocked));
  // A1 -> A3 passes it half a metre away.
  plan.tracks[0].back() = mark_at(9, grid, 0, 2);
  EXPECT_TRUE(validate(plan).valid());
  plan.stage.clearance_m = 1.0;
  EXPECT_TRUE(validate(plan).valid()) << "exactly half of the clearance is enough";
  plan.stage.clearance_m = 1.01;
  EXPECT_THAT(kinds_of(validate(plan)), ElementsAre(Kind::into_blocked));
}

TEST(Validate, KnowsTheOutlinesOfHexagonsAndTriangles) {
  for (const GridKind kind : {GridKind::hexagonal, GridKind::triangular}) {
    const Grid grid = grid_of(kind, 9, 9);
    const double inner_m = kind == GridKind::hexagonal ? 0.5 : 0.5;  // from a centre to its outline: p / 2 on both
    Plan plan = plan_of(grid, {{mark_at(0, grid, 4, 4), mark_at(9, grid, 4, 4)}});
    plan.stage.blocked = {grid.neighbours(grid.index({4, 4})).front()};
    plan.stage.clearance_m = 2 * inner_m - 1e-6;
    EXPECT_TRUE(validate(plan).valid()) << to_text(kind);
    plan.stage.clearance_m = 2 * inner_m + 1e-6;
    EXPECT_THAT(kinds_of(validate(plan)), ElementsAre(Kind::into_blocked)) << to_text(kind);
  }
}

TEST(Validate, FindsTwoPeopleOnOneCell) {
  Plan plan = calm_plan();
  plan.stage.max_speed_mps = 9;
  plan.tracks[1].back() = plan.tracks[0].back();
  const Verdict verdict = validate(plan);
  ASSERT_THAT(kinds_of(verdict), ElementsAre(Kind::same_cell, Kind::too_close));
  EXPECT_EQ(verdict.first[0].text, "performers 1 and 2 stand on one cell, B3, at 2.000 s");
  EXPECT_EQ(verdict.too_close, 1U);
}

TEST(Validate, FindsTwoPeopleWhoExchangeTheirCells) {
  const Grid grid = squares();
  const Plan plan = plan_of(
      grid, {{mark_at(0, grid, 1, 1), mark_at(4, grid, 2, 1)}, {mark_at(0, grid, 2, 1), mark_at(4, grid, 1, 1)}});
  const Verdict verdict = validate(plan);
  ASSERT_THAT(kinds_of(verdict), ElementsAre(Kind::too_close));
  EXPECT_EQ(verdict.first[0].text,
            "performers 1 (from B2 to C2) and 2 (from C2 to B2) come 0.000 m near at 2.000 s (at least 0.500 m)");
  EXPECT_EQ(verdict.first[0].time, instant_at(2));
  EXPECT_EQ(verdict.min_clearance_m, 0);
  EXPECT_EQ(verdict.closest_at, instant_at(2));
}

TEST(Validate, AllowsTheClearanceItselfAndNotAMicrometreAndAHalfLess) {
  Plan plan = calm_plan();
  plan.stage.clearance_m = 3.0 + 0.9e-6;
  EXPECT_TRUE(validate(plan).valid());
  plan.stage.clearance_m = 3.0 + 1.5e-6;
  EXPECT_THAT(kinds_of(validate(plan)), ElementsAre(Kind::too_close));
}

TEST(Validate, KeepsTheSumOfTwoRadiiWhereThatIsMore) {
  Plan plan = calm_plan();
  plan.radius_m = {2.0, 1.0};
  EXPECT_TRUE(validate(plan).valid());
  plan.radius_m = {2.0, 1.1};
  const Verdict verdict = validate(plan);
  ASSERT_THAT(kinds_of(verdict), ElementsAre(Kind::too_close));
  EXPECT_DOUBLE_EQ(verdict.first[0].limit, 3.1);
  plan.radius_m = {0.0, 0.2};
  EXPECT_TRUE(validate(plan).valid()) << "the stage's clearance is more";
}

TEST(Validate, FindsAWalkThatIsTooFast) {
  Plan plan = calm_plan();
  plan.stage.max_speed_mps = 0.5;
  EXPECT_TRUE(validate(plan).valid());
  plan.stage.max_speed_mps = 0.4999;
  const Verdict verdict = validate(plan);
  ASSERT_THAT(kinds_of(verdict), ElementsAre(Kind::too_fast, Kind::too_fast));
  EXPECT_EQ(verdict.first[0].text,
            "performer 1 walks 1.000 m from B2 to B3 in 2.000 s at 0.000 s: 0.500 m/s (at most 0.500 m/s)");
}

TEST(Validate, TakesThePersonsOwnSpeedLimitFirst) {
  Plan plan = calm_plan();
  plan.max_speed_mps = {0.4, 0.0};
  EXPECT_THAT(kinds_of(validate(plan)), ElementsAre(Kind::too_fast));
  plan.stage.max_speed_mps = 0.1;
  plan.max_speed_mps = {0.5, 0.5};
  EXPECT_TRUE(validate(plan).valid());
}

TEST(Validate, CountsAWalkBetweenSectionsToTheLaterOne) {
  const Grid grid = squares();
  Plan plan = plan_of(grid, {{mark_at(0, grid, 0, 0), mark_at(2, grid, 2, 0), mark_at(4, grid, 4, 0),
                              mark_at(6, grid, 6, 0), mark_at(8, grid, 8, 0)}});
  plan.stage.max_speed_mps = 1.0;
  plan.sections = {{"slow", kStart, instant_at(2), 1.0, {}, {}, {}},
                   {"later", instant_at(4), instant_at(6), 1.0, {}, {}, {}}};
  EXPECT_TRUE(validate(plan).valid());
  plan.sections[1].max_speed_mps = 0.9;  // the walk into it, and the one in it
  EXPECT_EQ(validate(plan).violations, 2U);
  plan.sections[0].max_speed_mps = 0.9;
  EXPECT_EQ(validate(plan).violations, 3U);
  plan.stage.max_speed_mps = 0.9;  // after the last section
  EXPECT_EQ(validate(plan).violations, 4U);
}

TEST(Validate, FindsAFormationThatDiffersFromTheMarks) {
  Plan plan = calm_plan();
  const Grid& grid = plan.stage.grid;
  Formation formation;
  formation.id = "growth/1";
  formation.time = instant_at(2);
  formation.cells = {grid.index({1, 2}), grid.index({4, 2})};
  plan.formations = {formation};
  EXPECT_TRUE(validate(plan).valid());
  plan.formations[0].cells[1] = grid.index({5, 2});
  Verdict verdict = validate(plan);
  ASSERT_THAT(kinds_of(verdict), ElementsAre(Kind::wrong_formation));
  EXPECT_EQ(verdict.first[0].text, "formation growth/1 at 2.000 s has performer 2 on F3, whose marks say on E3");
  plan.formations[0].cells.pop_back();
  verdict = validate(plan);
  ASSERT_THAT(kinds_of(verdict), ElementsAre(Kind::wrong_formation));
  EXPECT_EQ(verdict.first[0].text, "formation growth/1 has 1 cells for 2 performers");
}

TEST(Validate, AcceptsAFormationInTheMiddleOfAWait) {
  Plan plan = calm_plan();
  for (auto& track : plan.tracks) track.back().cell = track.front().cell;
  Formation formation;
  formation.time = instant_at(1);
  formation.cells = {plan.tracks[0][0].cell, plan.tracks[1][0].cell};
  plan.formations = {formation};
  EXPECT_TRUE(validate(plan).valid());
}

TEST(Validate, KeepsAHundredAndCountsAll) {
  const Grid grid = squares();
  std::vector<std::vector<Mark>> tracks(40, {mark_at(0, grid, 0, 0), mark_at(1, grid, 0, 0)});
  const Verdict verdict = validate(plan_of(grid, tracks));
  EXPECT_EQ(verdict.too_close, 780U);
  EXPECT_EQ(verdict.violations, 780U + 2 * 39U);
  EXPECT_EQ(verdict.first.size(), 100U);
  EXPECT_TRUE(std::is_sorted(verdict.first.begin(), verdict.first.end(),
                             [](const Violation& x, const Violation& y) { return x.time < y.time; }));
}

/// Everything by brute force: all pairs, all stretches between mark instants, in closed form with other words.
struct Brute {
  double nearest_m = std::numeric_limits<double>::infinity();
  std::uint64_t too_close = 0;
};
std::vector<Instant> all_times(const Plan& plan) {
  std::vector<Instant> times;
  for (const auto& track : plan.tracks) {
    for (const Mark& mark : track) times.push_back(mark.time);
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}
Brute brute_force(const Plan& plan) {
  Brute out;
  const std::vector<Instant> times = all_times(plan);
  const auto at = [&](std::size_t i, Instant t) { return position_at(plan.stage.grid, plan.tracks[i], t); };
  for (std::size_t k = 0; k + 1 < times.size(); ++k) {
    for (std::size_t i = 0; i < plan.tracks.size(); ++i) {
      for (std::size_t j = i + 1; j < plan.tracks.size(); ++j) {
        const Point d0 = at(i, times[k]) - at(j, times[k]);
        const Point d1 = at(i, times[k + 1]) - at(j, times[k + 1]);
        double least = std::min(length(d0), length(d1));
        const double way = squared_length(d1 - d0);
        const double share = way > 0 ? -dot(d0, d1 - d0) / way : -1;
        if (share > 0 && share < 1) least = std::min(least, std::abs(d0.x * d1.y - d0.y * d1.x) / std::sqrt(way));
        out.nearest_m = std::min(out.nearest_m, least);
        const double limit = std::max(plan.stage.clearance_m, plan.radius_m[i] + plan.radius_m[j]);
        out.too_close += least < limit - 1e-6 ? 1 : 0;
      }
    }
  }
  return out;
}

TEST(ValidateProperty, FindsEveryPairAndTheNearestOnEveryGrid) {
  const bool held = rc::check([](std::uint64_t seed) {
    Rng rng(seed);
    const Grid grid = grid_of(static_cast<GridKind>(rng.below(3)), 3 + static_cast<int>(rng.below(20)),
                              3 + static_cast<int>(rng.below(20)), 0.3 + rng.uniform());
    const std::size_t people = 2 + rng.below(std::min<std::size_t>(30, static_cast<std::size_t>(grid.size()) - 2));
    Plan plan = tests::random_plan(grid, people, 2 + static_cast<int>(rng.below(5)), rng.below(2) == 0, rng);
    plan.stage.clearance_m = 0.9 * rng.uniform();
    if (rng.below(2) == 0) {
      for (double& radius : plan.radius_m) radius = rng.uniform();
    }
    const Brute expected = brute_force(plan);
    const Verdict verdict = validate(plan);
    RC_ASSERT(std::abs(verdict.min_clearance_m - expected.nearest_m) < 1e-9);
    RC_ASSERT(verdict.too_close == expected.too_close);
    const Point a = position_at(grid, plan.tracks[verdict.closest_a.at()], verdict.closest_at);
    const Point b = position_at(grid, plan.tracks[verdict.closest_b.at()], verdict.closest_at);
    RC_ASSERT(std::abs(distance(a, b) - verdict.min_clearance_m) < 1e-6);
  });
  EXPECT_TRUE(held);
}

TEST(ValidateProperty, TheClosedFormIsWhatFineSamplingApproaches) {
  const bool held = rc::check([](std::uint64_t seed) {
    Rng rng(seed);
    const Grid grid = grid_of(static_cast<GridKind>(rng.below(3)), 12, 9);
    const Plan plan = tests::random_plan(grid, 8, 4, rng.below(2) == 0, rng);
    const Verdict verdict = validate(plan);
    constexpr int kSamples = 6000;
    const double step_s = 6.0 / kSamples;
    double sampled = std::numeric_limits<double>::infinity();
    for (int k = 0; k <= kSamples; ++k) {
      std::vector<Point> at;
      for (const auto& track : plan.tracks) at.push_back(position_at(grid, track, instant_at(step_s * k)));
      for (std::size_t i = 0; i < at.size(); ++i) {
        for (std::size_t j = i + 1; j < at.size(); ++j) sampled = std::min(sampled, distance(at[i], at[j]));
      }
    }
    RC_ASSERT(verdict.min_clearance_m <= sampled + 1e-9);
    RC_ASSERT(sampled - verdict.min_clearance_m <= 2 * verdict.max_speed_mps * step_s);
  });
  EXPECT_TRUE(held);
}

TEST(ValidateProperty, IsTheSameWhateverTheOrderOfPeople) {
  const bool held = rc::check([](std::uint64_t seed) {
    Rng rng(seed);
    Plan plan = tests::random_plan(squares(), 20, 4, true, rng);
    const Verdict before = validate(plan);
    std::reverse(plan.tracks.begin(), plan.tracks.end());
    const Verdict after = validate(plan);
    RC_ASSERT(before.min_clearance_m == after.min_clearance_m);
    RC_ASSERT(before.too_close == after.too_close);
    RC_ASSERT(before.violations == after.violations);
  });
  EXPECT_TRUE(held);
}

TEST(ClosestApproachTest, LooksOnlyAtItsStretch) {
  const Grid grid = squares();
  const Plan plan = plan_of(grid, {{mark_at(0, grid, 1, 1), mark_at(2, grid, 1, 2), mark_at(4, grid, 3, 2)},
                                   {mark_at(0, grid, 5, 1), mark_at(2, grid, 5, 2), mark_at(4, grid, 4, 2)}});
  const ClosestApproach first = closest_approach(plan, kStart, instant_at(2));
  EXPECT_DOUBLE_EQ(first.distance_m, 4.0);
  EXPECT_EQ(first.at, kStart);
  const ClosestApproach second = closest_approach(plan, instant_at(2), instant_at(4));
  EXPECT_DOUBLE_EQ(second.distance_m, 1.0);
  EXPECT_EQ(second.at, instant_at(4));
  EXPECT_EQ(second.a, PerformerIndex(0));
  EXPECT_EQ(second.b, PerformerIndex(1));
}

/// The order of targets with the least sum of squared distances, by trying all.
std::vector<CellIndex> squared_optimum(const Grid& grid, const std::vector<CellIndex>& from,
                                       std::vector<CellIndex> to) {
  std::sort(to.begin(), to.end());
  std::vector<CellIndex> best = to;
  double least = std::numeric_limits<double>::infinity();
  do {
    double sum = 0;
    for (std::size_t i = 0; i < from.size(); ++i) sum += squared_length(grid.centre(from[i]) - grid.centre(to[i]));
    if (sum < least) {
      least = sum;
      best = to;
    }
  } while (std::next_permutation(to.begin(), to.end()));
  return best;
}

TEST(SeparationTheorem, SquaredOptimalPairingsKeepTheGridsBound) {
  const bool held = rc::check([](std::uint64_t seed) {
    Rng rng(seed);
    const Grid grid = grid_of(static_cast<GridKind>(rng.below(3)), 4, 4);
    const std::size_t people = 2 + rng.below(5);
    const std::vector<CellIndex> from = tests::random_cells(grid, people, rng);
    const std::vector<CellIndex> to = squared_optimum(grid, from, tests::random_cells(grid, people, rng));
    std::vector<std::vector<Mark>> tracks;
    for (std::size_t i = 0; i < people; ++i) tracks.push_back({{kStart, from[i]}, {instant_at(9), to[i]}});
    Plan plan = plan_of(grid, tracks);
    plan.stage.clearance_m = grid.clearance_bound_m();
    const Verdict verdict = validate(plan);
    RC_ASSERT(verdict.valid());
    RC_ASSERT(verdict.min_clearance_m >= grid.clearance_bound_m() - 1e-9);
  });
  EXPECT_TRUE(held);
}

TEST(SeparationTheorem, TheBoundIsReachedOnSquares) {
  const Grid grid = squares();
  // One leaves a cell upstage while another enters it from the side.
  Plan plan = plan_of(
      grid, {{mark_at(0, grid, 1, 1), mark_at(2, grid, 1, 2)}, {mark_at(0, grid, 0, 1), mark_at(2, grid, 1, 1)}});
  EXPECT_NEAR(validate(plan).min_clearance_m, grid.clearance_bound_m(), 1e-12);
}

TEST(ToleratedLag, IsTheCapForPeopleWhoNeverMeet) {
  EXPECT_EQ(tolerated_lag_s(calm_plan(), kStart, instant_at(2)), 2.0);
  EXPECT_EQ(tolerated_lag_s(calm_plan(), kStart, instant_at(2), 0.7), 0.7);
}

TEST(ToleratedLag, IsNothingForPeopleWhoAreTooCloseOnTime) {
  const Grid grid = squares();
  const Plan plan = plan_of(
      grid, {{mark_at(0, grid, 1, 1), mark_at(4, grid, 2, 1)}, {mark_at(0, grid, 2, 1), mark_at(4, grid, 1, 1)}});
  EXPECT_EQ(tolerated_lag_s(plan, kStart, instant_at(4)), 0.0);
}

TEST(ToleratedLag, IsTheSpareWayOverTheSpeedForPeopleInAFile) {
  const Grid grid = squares();
  // One metre apart at 1 m/s: who starts L late lets the one behind come L metres nearer.
  Plan plan = plan_of(
      grid, {{mark_at(0, grid, 1, 1), mark_at(3, grid, 4, 1)}, {mark_at(0, grid, 2, 1), mark_at(3, grid, 5, 1)}});
  plan.stage.clearance_m = 0.4;
  EXPECT_NEAR(tolerated_lag_s(plan, kStart, instant_at(3)), 0.6, 1e-5);
  plan.stage.clearance_m = 0.8;
  EXPECT_NEAR(tolerated_lag_s(plan, kStart, instant_at(3)), 0.2, 1e-5);
}

TEST(ToleratedLag, SeesOneStillArrivingWhenTheOtherLeavesForTheNextMark) {
  const Grid grid = squares();
  // The second walks from B2 to C2 until 2 s; the first waits on A2 and then walks to B2 within a second.
  Plan plan = plan_of(grid, {{mark_at(0, grid, 0, 1), mark_at(2, grid, 0, 1), mark_at(3, grid, 1, 1)},
                             {mark_at(0, grid, 1, 1), mark_at(2, grid, 2, 1), mark_at(3, grid, 2, 1)}});
  plan.stage.clearance_m = 0.8;
  // When the first is on B2, at 3 s, the second who is L late is (3 - L) / 2 on her way: 1 + (3 - L) / 2 - 1 >= 0.8.
  EXPECT_NEAR(tolerated_lag_s(plan, kStart, instant_at(2)), 1.4, 1e-5);
}

/// Whether a pair comes too near when late by up to lag_s, by looking at many pairs of times.
bool sampled_clear(const Plan& plan, double start_s, double end_s, double lag_s, double limit_m) {
  constexpr int kSamples = 160;
  const double last_s = to_seconds(plan.tracks[0].back().time);
  const auto at = [&](std::size_t i, double t) { return position_at(plan.stage.grid, plan.tracks[i], instant_at(t)); };
  for (std::size_t i = 0; i < plan.tracks.size(); ++i) {
    for (std::size_t j = 0; j < plan.tracks.size(); ++j) {
      if (i == j) continue;
      for (int k = 0; k <= kSamples; ++k) {
        const double s = start_s + (end_s - start_s) * k / kSamples;
        for (int l = 0; l <= kSamples / 4; ++l) {
          const double u = std::min(last_s, s + lag_s * l / (kSamples / 4));
          if (distance(at(i, s), at(j, u)) < limit_m) return false;
        }
      }
    }
  }
  return true;
}

TEST(ToleratedLagProperty, AgreesWithSamplingAllLatenesses) {
  const bool held = rc::check([](std::uint64_t seed) {
    Rng rng(seed);
    const Grid grid = grid_of(static_cast<GridKind>(rng.below(3)), 6, 6);
    Plan plan = tests::random_plan(grid, 4, 4, rng.below(2) == 0, rng);
    plan.stage.clearance_m = 0.1 + 0.2 * rng.uniform();
    const double start_s = 2.0 * static_cast<double>(rng.below(3));
    const double lag_s = tolerated_lag_s(plan, instant_at(start_s), instant_at(start_s + 2), 1.5);
    const double slack_m = validate(plan).max_speed_mps * (2.0 / 160 + 1.5 / 40);  // between neighbouring samples
    if (lag_s > 0) RC_ASSERT(sampled_clear(plan, start_s, start_s + 2, lag_s, plan.stage.clearance_m - 2e-6));
    if (lag_s < 1.5) {
      RC_ASSERT(!sampled_clear(plan, start_s, start_s + 2, lag_s + 1e-5, plan.stage.clearance_m + slack_m));
    }
  });
  EXPECT_TRUE(held);
}

TEST(ToleratedLagProperty, FallsWhenTheClearanceRises) {
  const bool held = rc::check([](std::uint64_t seed) {
    Rng rng(seed);
    Plan plan = tests::random_plan(squares(), 6, 3, true, rng);
    double before = 2.0;
    for (const double clearance_m : {0.05, 0.1, 0.3, 0.6, 0.9}) {
      plan.stage.clearance_m = clearance_m;
      const double now = tolerated_lag_s(plan, kStart, instant_at(2));
      RC_ASSERT(now <= before);
      before = now;
    }
  });
  EXPECT_TRUE(held);
}

}  // namespace
}  // namespace footlight::planner
