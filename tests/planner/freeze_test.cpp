// SPDX-License-Identifier: Apache-2.0
#include "planner/freeze.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "planner/validate.hpp"
#include "tests/support/plan_builder.hpp"

namespace footlight::planner {
namespace {

using tests::mark_at;
using tests::plan_of;

Grid squares() { return Grid::make(GridKind::square, 8, 6, 1.0).value(); }

/// Two in a file, a metre apart, at 1 m/s for three seconds; then they stand for one.
Plan file() {
  const Grid grid = squares();
  Plan plan = plan_of(grid, {{mark_at(0, grid, 1, 1), mark_at(3, grid, 4, 1), mark_at(4, grid, 4, 1)},
                             {mark_at(0, grid, 2, 1), mark_at(3, grid, 5, 1), mark_at(4, grid, 5, 1)}});
  plan.stage.clearance_m = 0.4;
  return plan;
}

TEST(Freeze, InAFileTheOneBehindMayRunIntoWhoHasStopped) {
  const FreezeAt at = judge_freeze_at(file(), {}, instant_at(1));
  ASSERT_EQ(at.freeze.size(), 1U);
  EXPECT_EQ(at.freeze[0].a, 0U);
  EXPECT_EQ(at.freeze[0].b, 1U);
  EXPECT_EQ(at.freeze[0].from, kStart);
  // From 2.4 s on the way that is left is shorter than the 0.6 m that are to spare.
  EXPECT_NEAR(to_seconds(at.freeze[0].until), 2.4, 2e-6);
}

TEST(Freeze, IsSafeForPeopleWhoStopSoonEnough) {
  const FreezeJudgement judged = judge_freezes(file(), {}, milliseconds(599));
  EXPECT_EQ(judged.freeze_pairs, 0U);
  EXPECT_EQ(judged.freeze.at(instant_at(1)), 0U);
  EXPECT_EQ(judge_freezes(file(), {}, milliseconds(601)).freeze_pairs, 1U);
}

TEST(Freeze, NobodyPassesAnInstantAtWhichTheShowWaits) {
  const Grid grid = squares();
  // The second leaves B2 after 2 s, when the first has come to A2; at 3 s the first stands there, too.
  Plan plan = plan_of(grid, {{mark_at(0, grid, 0, 3), mark_at(2, grid, 0, 1), mark_at(4, grid, 2, 1)},
                             {mark_at(0, grid, 1, 1), mark_at(2, grid, 1, 1), mark_at(4, grid, 3, 1)}});
  plan.stage.clearance_m = 0.5;
  EXPECT_EQ(judge_freezes(plan, {}).freeze.at(instant_at(1.5)), 1U);
  const std::vector<Instant> waits{instant_at(2)};
  const FreezeJudgement judged = judge_freezes(plan, waits);
  EXPECT_EQ(judged.freeze.at(instant_at(1.5)), 0U);
  EXPECT_EQ(judged.freeze.at(instant_at(2)), 1U);
  EXPECT_EQ(judged.freeze.none_from(instant_at(1.5)), instant_at(1.5));
  EXPECT_NEAR(to_seconds(judged.freeze.none_from(instant_at(2))), 3.5, 2e-6);
}

TEST(Freeze, PeopleWhoStandAreSafe) {
  const Grid grid = squares();
  Plan plan = plan_of(
      grid, {{mark_at(0, grid, 1, 1), mark_at(9, grid, 1, 1)}, {mark_at(0, grid, 2, 1), mark_at(9, grid, 2, 1)}});
  plan.stage.clearance_m = 1;
  EXPECT_EQ(judge_freezes(plan, {}).freeze_pairs, 0U);
}

TEST(Freeze, GoingOnTheOneAheadOfTheShowMeetsWhoIsOnTime) {
  // Stopped at 1 s, the first has gone on by 1.5 s and goes on so far ahead: the second is on time and too near, until
  // 2.4 s of the show, when the way that the first has left is shorter than what is to spare.
  const FreezeAt at = judge_freeze_at(file(), {}, instant_at(1));
  ASSERT_EQ(at.resume.size(), 1U);
  EXPECT_EQ(at.resume[0].from, kStart);
  EXPECT_NEAR(to_seconds(at.resume[0].until), 2.4, 2e-6);
}

TEST(Freeze, GoingOnWhoHasComeToHerMarkWaitsThereForTheShow) {
  const Grid grid = squares();
  // The first comes to B2 and waits for a second before she crosses the second one's way at 5.5 s.
  Plan plan =
      plan_of(grid, {{mark_at(0, grid, 0, 1), mark_at(3, grid, 1, 1), mark_at(4, grid, 1, 1), mark_at(8, grid, 5, 1)},
                     {mark_at(0, grid, 3, 1), mark_at(5, grid, 3, 1), mark_at(7, grid, 3, 5), mark_at(8, grid, 3, 5)}});
  plan.stage.clearance_m = 0.5;
  const FreezeJudgement judged = judge_freezes(plan, {}, seconds(1));
  EXPECT_EQ(judged.resume.at(instant_at(1)), 0U) << "she is on time again long before they meet";
  EXPECT_EQ(judged.resume.at(instant_at(3.1)), 1U) << "whoever begins at 4 s may be ahead on that way";
  EXPECT_EQ(judged.freeze.at(instant_at(3.1)), 0U);
}

TEST(TouchCount, CountsPairsAsAFunctionOfTime) {
  const TouchCount count(std::vector<Touch>{{instant_at(1), instant_at(3), 0, 1},
                                            {instant_at(2), instant_at(5), 0, 2},
                                            {instant_at(3), instant_at(4), 1, 2}});
  EXPECT_EQ(count.at(instant_at(0.5)), 0U);
  EXPECT_EQ(count.at(instant_at(1)), 1U);
  EXPECT_EQ(count.at(instant_at(3)), 2U);
  EXPECT_EQ(count.at(instant_at(5)), 0U);
  EXPECT_EQ(count.none_from(instant_at(0.5)), instant_at(0.5));
  EXPECT_EQ(count.none_from(instant_at(1.5)), instant_at(5));
  EXPECT_EQ(count.safe_in(kStart, instant_at(6)), seconds(2));
  const auto worst = count.worst_in(kStart, instant_at(6));
  EXPECT_EQ(worst.pairs, 2U);
  EXPECT_EQ(worst.at, instant_at(2));
}

// ---- against people who are tried one by one

constexpr double kStep_s = 0.05;

struct Tried {
  const Plan& plan;
  double until_s;  ///< the show waits, or ends
  double late_s;
  [[nodiscard]] Point at(std::uint32_t who, double t_s) const {
    return position_at(plan.stage.grid, plan.tracks[who], instant_at(t_s));
  }
  [[nodiscard]] std::vector<double> between(double from_s, double to_s) const {
    std::vector<double> times{from_s};
    while (times.back() + kStep_s < to_s) times.push_back(times.back() + kStep_s);
    if (to_s > from_s) times.push_back(to_s);
    return times;
  }
  [[nodiscard]] double nearest(std::uint32_t a, const std::vector<double>& as, std::uint32_t b,
                               const std::vector<double>& bs) const {
    double least_m = 1e9;
    for (const double s : as) {
      for (const double u : bs) least_m = std::min(least_m, distance(at(a, s), at(b, u)));
    }
    return least_m;
  }
  /// Nobody is late.
  [[nodiscard]] double on_time(std::uint32_t a, std::uint32_t b) const {
    double least_m = 1e9;
    for (int k = 0; k <= 6000; ++k) least_m = std::min(least_m, distance(at(a, 0.001 * k), at(b, 0.001 * k)));
    return least_m;
  }
  /// Each stops anywhere on what lies before her.
  [[nodiscard]] double stopping(std::uint32_t a, std::uint32_t b, double freeze_s) const {
    const auto times = between(freeze_s, std::min(until_s, freeze_s + late_s));
    return nearest(a, times, b, times);
  }
  /// Each is anywhere ahead of the show, but not beyond the mark that she may have come to or passed before.
  [[nodiscard]] double going_on(std::uint32_t a, std::uint32_t b, double freeze_s) const {
    const auto window = [&](std::uint32_t who) {
      for (const Mark& mark : plan.tracks[who]) {
        if (to_seconds(mark.time) >= freeze_s + late_s) return std::min(until_s, to_seconds(mark.time));
      }
      return until_s;
    };
    double least_m = 1e9;
    for (const double t : between(freeze_s, until_s)) {
      const auto ahead = [&](std::uint32_t who) { return between(t, std::max(t, std::min(t + late_s, window(who)))); };
      least_m = std::min(least_m, nearest(a, ahead(a), b, ahead(b)));
    }
    return least_m;
  }
};

bool holds(const std::vector<Touch>& touches, std::uint32_t a, std::uint32_t b) {
  return std::ranges::any_of(touches, [&](const Touch& touch) { return touch.a == a && touch.b == b; });
}

TEST(FreezeProperty, AgreesWithTryingWhereEverybodyMayStopAndGoOn) {
  int unsafe = 0;
  int safe = 0;
  const bool held = rc::check([&](std::uint64_t seed) {
    Rng rng(seed);
    const Grid grid = Grid::make(static_cast<GridKind>(rng.below(3)), 6, 6, 1.0).value();
    Plan plan = tests::random_plan(grid, 3, 4, rng.below(2) == 0, rng);
    plan.stage.clearance_m = 0.1 + 0.5 * rng.uniform();
    if (rng.below(3) == 0) plan.radius_m = {0.4, 0, 0.3};
    std::vector<Instant> waits;
    if (rng.below(2) == 0) waits.push_back(instant_at(2.0 * static_cast<double>(1 + rng.below(2))));
    const double late_s = 0.2 + 1.3 * rng.uniform();
    const FreezeJudgement judged = judge_freezes(plan, waits, seconds(late_s));
    const double slack_m = 3 * kStep_s * validate(plan).max_speed_mps;
    for (int k = 0; k < 4; ++k) {
      const double freeze_s = 5.9 * rng.uniform();
      const bool before = !waits.empty() && instant_at(freeze_s) < waits[0];
      const Tried tried{plan, before ? to_seconds(waits[0]) : 6.0, late_s};
      const FreezeAt at = judge_freeze_at(plan, waits, instant_at(freeze_s), seconds(late_s));
      RC_ASSERT(judged.freeze.at(instant_at(freeze_s)) == at.freeze.size());
      RC_ASSERT(judged.resume.at(instant_at(freeze_s)) == at.resume.size());
      for (std::uint32_t a = 0; a < 3; ++a) {
        for (std::uint32_t b = a + 1; b < 3; ++b) {
          const double limit_m = std::max(plan.stage.clearance_m, plan.radius_m[a] + plan.radius_m[b]);
          if (tried.on_time(a, b) < limit_m + 0.02) continue;  // a plan would be refused for them
          const double stopping_m = tried.stopping(a, b, freeze_s);
          const double going_on_m = tried.going_on(a, b, freeze_s);
          if (holds(at.freeze, a, b)) RC_ASSERT(stopping_m <= limit_m + slack_m);
          if (!holds(at.freeze, a, b)) RC_ASSERT(stopping_m >= limit_m - 1e-5);
          if (holds(at.resume, a, b)) RC_ASSERT(going_on_m <= limit_m + slack_m);
          if (!holds(at.resume, a, b)) RC_ASSERT(going_on_m >= limit_m - 1e-5);
          ++(holds(at.freeze, a, b) ? unsafe : safe);
        }
      }
    }
  });
  EXPECT_TRUE(held);
  EXPECT_GT(unsafe, 10);
  EXPECT_GT(safe, 50);
}

TEST(FreezeProperty, IsNoSaferForPeopleWhoStopLater) {
  EXPECT_TRUE(rc::check([](std::uint64_t seed) {
    Rng rng(seed);
    Plan plan = tests::random_plan(squares(), 8, 4, true, rng);
    plan.stage.clearance_m = 0.3;
    std::uint32_t before = 0;
    const Instant freeze = instant_at(5 * rng.uniform());
    for (const double late_s : {0.2, 0.6, 1.0, 1.5}) {
      const std::uint32_t now = judge_freezes(plan, {}, seconds(late_s)).freeze.at(freeze);
      RC_ASSERT(now >= before);
      before = now;
    }
  }));
}

}  // namespace
}  // namespace footlight::planner
