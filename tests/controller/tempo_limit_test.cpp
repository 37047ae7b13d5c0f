// SPDX-License-Identifier: Apache-2.0
#include "controller/tempo_limit.hpp"

#include <gtest/gtest.h>

#include "controller/cue_engine.hpp"
#include "tests/support/small_show.hpp"

namespace footlight::controller {
namespace {

using tests::mark_at;

/// Two sections of one walk each: 3.4 m in 1 s at most 4 m/s; then 1 m in 2 s.
struct Bench {
  Bench() {
    small = tests::random_show(8, 4, 2, 2, 1, 1);
    const Grid& grid = small.plan.stage.grid;
    small.plan.tracks = {
        {mark_at(0, grid, 0, 0), mark_at(2, grid, 6, 0), mark_at(6, grid, 6, 0), mark_at(8, grid, 7, 0)},
        {mark_at(0, grid, 0, 2), mark_at(2, grid, 1, 2), mark_at(6, grid, 1, 2), mark_at(8, grid, 1, 2)}};
    small.plan.sections[0].max_speed_mps = 3.54;
    small.plan.sections[1].max_speed_mps = 4;
    schedule.emplace(build_schedule(small.show, small.plan, {}, {}).value());
    plays = cue_plays(small.show, small.plan);
  }
  [[nodiscard]] std::vector<TempoLimit> limits(const std::vector<BusNeed>& needs = {}, const Rig& rig = {}) const {
    return tempo_limits(small.plan, small.show.tempo, plays, *schedule, needs, rig);
  }
  tests::SmallShow small;
  std::optional<CueSchedule> schedule;
  std::vector<CuePlay> plays;
};

TEST(TempoLimit, IsWhereSomebodyWouldWalkFasterThanProved) {
  const Bench bench;
  const auto limits = bench.limits();
  ASSERT_EQ(limits.size(), 2U);
  EXPECT_EQ(limits[0].percent, 118);
  EXPECT_EQ(limits[0].because, "performer 1 walks at 3.00 of 3.54 m/s at count 1");
  EXPECT_EQ(limits[1].percent, kFastest_percent);
  EXPECT_EQ(limits[1].because, "");
}

TEST(TempoLimit, SomebodysOwnLimitCounts) {
  Bench bench;
  bench.small.plan.max_speed_mps[0] = 3.0;
  EXPECT_EQ(bench.limits()[0].percent, 100) << "a plan may use all of its limit";
}

TEST(TempoLimit, IsWhereABusCouldNotCarryTheNextSwitchInTime) {
  Bench bench;
  Rig rig;
  rig.buses.push_back({"left", BusKind::serial, "sim://serial", 115'200, std::nullopt, {}});
  BusNeed need;
  need.k = 2;
  while (bench.schedule->switches()[need.k - 1].settled) ++need.k;
  need.changed = 3;
  need.preloads = milliseconds(500);
  need.available = milliseconds(1000);
  const auto limits = bench.limits({need}, rig);
  const std::size_t cue = *bench.schedule->switches()[need.k].cue;
  EXPECT_EQ(limits[cue].percent, cue == 0 ? 118 : 140);
  need.preloads = milliseconds(650);
  EXPECT_EQ(bench.limits({need}, rig)[cue].percent, 107);
  EXPECT_EQ(bench.limits({need}, rig)[cue].because,
            "bus \"left\" needs 650 of 700 ms for " + bench.schedule->switches()[need.k].cause);
}

}  // namespace
}  // namespace footlight::controller
