// SPDX-License-Identifier: Apache-2.0
#include "planner/repair/lateness.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"

namespace footlight::planner {
namespace {

Point at(const TimedWalk& timed, double share) {
  const double walked = std::clamp((share - timed.start) / (timed.end - timed.start), 0.0, 1.0);
  return timed.walk.from + walked * (timed.walk.to - timed.walk.from);
}

TEST(Lateness, WhoFollowsAnotherComesNearerByWhatTheOtherIsLate) {
  const TimedWalk ahead{{{1, 0}, {5, 0}}};
  const TimedWalk behind{{{0, 0}, {4, 0}}};
  EXPECT_DOUBLE_EQ(least_squared_when_late_m2(ahead, behind, 0), 1);
  EXPECT_NEAR(least_squared_when_late_m2(ahead, behind, 0.1), 0.36, 1e-12);
  EXPECT_NEAR(least_squared_when_late_m2(ahead, behind, 0.5), 0, 1e-12);
}

TEST(Lateness, WhoLeavesLaterKeepsFurtherFromTheOneAhead) {
  const TimedWalk ahead{{{1, 0}, {5, 0}}};
  const TimedWalk behind{{{0, 0}, {3, 0}}, 0.25, 1};
  EXPECT_NEAR(least_squared_when_late_m2(ahead, behind, 0.1), 1.0, 1e-12) << "nearest before either has left";
  EXPECT_NEAR(least_squared_when_late_m2(ahead, behind, 0.25), 1.0, 1e-12);
  EXPECT_LT(least_squared_when_late_m2(ahead, behind, 0.3), 1.0);
}

TEST(Lateness, WhoWalkBesideEachOtherMayBeAsLateAsTheyLike) {
  EXPECT_DOUBLE_EQ(least_squared_when_late_m2({{{0, 0}, {4, 0}}}, {{{0, 1}, {4, 1}}}, 1), 1);
}

TEST(Lateness, PathsThatCrossMeetWhenTheDelayIsLongEnough) {
  const TimedWalk across{{{0, 1}, {2, 1}}};
  const TimedWalk along{{{1, -1}, {1, 3}}};
  EXPECT_DOUBLE_EQ(least_squared_when_late_m2(across, along, 0), 0) << "both are at (1, 1) at half of the time";
  const TimedWalk earlier{{{1, 0}, {1, 4}}};  // at (1, 1) a quarter of the time before
  EXPECT_GT(least_squared_when_late_m2(across, earlier, 0.24), 0);
  EXPECT_DOUBLE_EQ(least_squared_when_late_m2(across, earlier, 0.26), 0);
}

TEST(Lateness, IsTheLeastOfAllPairsOfClocksThatFitTheDelay) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    const auto point = [&] { return Point{double(rng.below(7)), double(rng.below(7))}; };
    const auto timed = [&] {
      const bool waits = rng.below(2) == 0;
      const double start = waits ? 0.4 * rng.uniform() : 0;
      return TimedWalk{{point(), point()}, start, waits ? 1 - 0.4 * rng.uniform() : 1};
    };
    const TimedWalk a = timed();
    const TimedWalk b = timed();
    const double share = rng.below(4) == 0 ? 0.0 : rng.uniform();
    const double least = std::sqrt(least_squared_when_late_m2(a, b, share));
    constexpr int kSteps = 60;
    double sampled = 1e9;
    for (int i = 0; i <= kSteps; ++i) {
      const double s = double(i) / kSteps;
      for (int j = 0; j <= kSteps; ++j) {
        const double u = std::clamp(s - share + 2 * share * j / kSteps, 0.0, 1.0);
        const double apart_m = distance(at(a, s), at(b, u));
        RC_ASSERT(apart_m >= least - 1e-9);
        sampled = std::min(sampled, apart_m);
      }
    }
    // Between samples nobody walks more than a step of a diagonal of the floor, at five times the pace.
    RC_ASSERT(sampled <= least + 5 * 2 * 8.5 / kSteps);
    RC_ASSERT(std::abs(std::sqrt(least_squared_when_late_m2(b, a, share)) - least) < 1e-9);
    const auto knots = [](const TimedWalk& one) {
      std::vector<Knot> out;
      if (one.start > 0) out.push_back({0, one.walk.from});
      out.push_back({one.start, one.walk.from});
      out.push_back({one.end, one.walk.to});
      if (one.end < 1) out.push_back({1, one.walk.to});
      return out;
    };
    RC_ASSERT(std::abs(std::sqrt(least_squared_along_m2(knots(a), knots(b), share)) - least) < 1e-9);
  }));
}

TEST(LeastSquaredAlong, PartsOfWalksThatAreNotThereTogetherNeverMeet) {
  const std::vector<Knot> early{{0, {0, 0}}, {0.4, {4, 0}}};
  const std::vector<Knot> late{{0.6, {4, 0}}, {1, {0, 0}}};
  EXPECT_EQ(least_squared_along_m2(early, late, 0.1), std::numeric_limits<double>::infinity());
  EXPECT_EQ(least_squared_along_m2(early, late, 0.2), 0);
}

}  // namespace
}  // namespace footlight::planner
