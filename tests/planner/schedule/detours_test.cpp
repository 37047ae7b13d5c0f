// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/detours.hpp"

#include <numeric>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "planner/validate.hpp"
#include "tests/planner/random_places.hpp"

namespace footlight::planner {
namespace {

constexpr double kClearance_m = 0.5;
constexpr double kSpeed_mps = 1.4;

/// Walks between two instants with a kind of one's own for everybody who may not take another's target.
struct Walks {
  Walks(const Ways& ways, std::vector<CellIndex> from, std::vector<CellIndex> to, double time_s, double lag_s = 0)
      : from_(std::move(from)), to_(std::move(to)), kind_(from_.size()) {
    std::iota(kind_.begin(), kind_.end(), 0U);
    task_ = {&ways, from_, to_, kClearance_m, kSpeed_mps, time_s, lag_s};
  }
  [[nodiscard]] Leg settled() const {
    LegTask leg{task_.ways, from_, to_, kSpeed_mps * task_.time_s - 1e-9, kClearance_m, kind_};
    leg.late_share = task_.lag_s / task_.time_s;
    leg.stagger_share = task_.beat_s / task_.time_s;
    leg.radius_m = task_.radius_m;
    return settle(leg);
  }
  [[nodiscard]] Plan plan_of(const Leg& leg) const {
    Plan plan = tests::plan_of(task_.ways->grid(), {});
    plan.stage.clearance_m = kClearance_m;
    plan.stage.max_speed_mps = kSpeed_mps;
    plan.sections.push_back({"all", kStart, instant_at(task_.time_s), kSpeed_mps, {}, {}, {}});
    for (std::uint32_t i = 0; i < from_.size(); ++i) {
      plan.performers.push_back(std::to_string(i + 1));
      plan.max_speed_mps.push_back(0);
      plan.radius_m.push_back(task_.radius_m.empty() ? 0 : task_.radius_m[i]);
      std::vector<Mark>& track = plan.tracks.emplace_back();
      const auto mark = [&](double share, CellIndex cell) {
        const Instant time = instant_at(share * task_.time_s);
        if (track.empty() || track.back().time < time) track.push_back({time, cell});
      };
      const Leg::Timing when = leg.timing.empty() ? Leg::Timing{} : leg.timing[i];
      mark(0, from_[i]);
      mark(when.start, from_[i]);
      for (const Leg::Via& via : leg.vias) {
        if (via.person == i) mark(via.at, via.cell);
      }
      mark(when.end, to_[leg.target_of[i]]);
      mark(1, to_[leg.target_of[i]]);
    }
    return plan;
  }

  std::vector<CellIndex> from_;
  std::vector<CellIndex> to_;
  std::vector<std::uint32_t> kind_;
  DetourTask task_;
};

class Detour : public testing::Test {
 protected:
  Detour() { stage_.grid = *Grid::make(GridKind::square, 14, 12, 1.0); }
  [[nodiscard]] CellIndex cell(int column, int row) const { return stage_.grid.index({column, row}); }
  Stage stage_;
};

TEST_F(Detour, OnlyWhoIsInSomebodysWayGetsAMark) {
  const Ways ways(stage_, 0.25);
  const Walks walks(ways, {cell(2, 5), cell(9, 5), cell(2, 9)}, {cell(9, 5), cell(2, 5), cell(9, 9)}, 10, 0.2);
  Leg straight;
  straight.target_of = {0, 1, 2};
  straight.conflicts = {{0, 1}};
  EXPECT_FALSE(validate(walks.plan_of(straight)).valid());
  const auto leg = detour(walks.task_, straight, {});
  ASSERT_TRUE(leg);
  EXPECT_EQ(leg->target_of, straight.target_of);
  ASSERT_EQ(leg->vias.size(), 1U) << "one of the two goes over one cell";
  EXPECT_LT(leg->vias.front().person, 2U);
  const Plan plan = walks.plan_of(*leg);
  EXPECT_TRUE(validate(plan).valid());
  EXPECT_GE(tolerated_lag_s(plan, kStart, instant_at(10)), 0.2 - 1e-6);
  EXPECT_EQ(plan.tracks[2].size(), 2U);
}

TEST_F(Detour, WhoStandsInTheWayStepsAsideAndComesBack) {
  stage_.grid = *Grid::make(GridKind::square, 14, 2, 1.0);
  const Ways ways(stage_, 0.25);
  // Along a passage that is two cells wide, past somebody on each side.
  const Walks walks(ways, {cell(1, 0), cell(6, 0), cell(6, 1)}, {cell(12, 0), cell(6, 0), cell(6, 1)}, 25);
  Leg straight;
  straight.target_of = {0, 1, 2};
  straight.conflicts = {{0, 1}};
  const auto leg = detour(walks.task_, straight, {});
  ASSERT_TRUE(leg);
  EXPECT_TRUE(validate(walks.plan_of(*leg)).valid());
}

TEST_F(Detour, KeepsOffBlockedCells) {
  for (int row = 0; row < 9; ++row) stage_.blocked.push_back(cell(6, row));
  const Ways ways(stage_, 0.25);
  const Walks walks(ways, {cell(2, 10), cell(9, 10)}, {cell(9, 10), cell(2, 10)}, 12);
  Leg straight;
  straight.target_of = {0, 1};
  straight.conflicts = {{0, 1}};
  const auto leg = detour(walks.task_, straight, {});
  ASSERT_TRUE(leg);
  Plan plan = walks.plan_of(*leg);
  plan.stage.blocked = stage_.blocked;
  EXPECT_TRUE(validate(plan).valid());
}

TEST_F(Detour, FindsNothingWhereThereIsNoRoomOrNoTime) {
  stage_.grid = *Grid::make(GridKind::square, 9, 1, 1.0);
  const Ways narrow(stage_, 0.25);
  const Walks walks(narrow, {cell(0, 0), cell(8, 0)}, {cell(8, 0), cell(0, 0)}, 30);
  Leg straight;
  straight.target_of = {0, 1};
  straight.conflicts = {{0, 1}};
  EXPECT_FALSE(detour(walks.task_, straight, {}));
  Stage wide;
  wide.grid = *Grid::make(GridKind::square, 9, 5, 1.0);
  const Ways ways(wide, 0.25);
  const auto row = [&](int column) { return wide.grid.index({column, 2}); };
  const Walks hurried(ways, {row(0), row(8)}, {row(8), row(0)}, 8 / kSpeed_mps + 0.01);
  EXPECT_FALSE(detour(hurried.task_, straight, {}));
}

TEST_F(Detour, StopsWhenToldTo) {
  const Ways ways(stage_, 0.25);
  const Walks walks(ways, {cell(2, 5), cell(9, 5)}, {cell(9, 5), cell(2, 5)}, 10);
  Leg straight;
  straight.target_of = {0, 1};
  straight.conflicts = {{0, 1}};
  const std::atomic<bool> stop{true};
  EXPECT_FALSE(detour(walks.task_, straight, {{}, &stop}));
}

TEST_F(Detour, WhateverIsFoundIsSoundAndEverybodyKeepsHerTarget) {
  int found_all = 0;
  EXPECT_TRUE(rc::check([&] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    Stage stage;
    stage.grid = *Grid::make(static_cast<GridKind>(rng.below(3)), 11, 10, 1.0);
    const Ways ways(stage, 0.25);
    const std::size_t people = 2 + rng.below(24);
    const double lag_s = rng.below(2) == 0 ? 0.0 : 0.2;
    auto from = random_places(ways, people, rng);
    auto to = random_places(ways, people, rng);
    Walks walks(ways, std::move(from), std::move(to), 15 + rng.uniform(), lag_s);
    std::vector<double> radius_m(people, 0);
    if (rng.below(3) == 0) radius_m[0] = radius_m[1] = 0.45;
    walks.task_.radius_m = radius_m;
    const Leg settled = walks.settled();
    if (settled.conflicts.empty() && settled.late_conflicts.empty()) return;
    const auto leg = detour(walks.task_, settled, {});
    if (!leg) return;
    ++found_all;
    RC_ASSERT(leg->target_of == settled.target_of);
    const Plan plan = walks.plan_of(*leg);
    const Verdict verdict = validate(plan);
    if (!verdict.valid()) RC_FAIL(verdict.first.front().text);
    RC_ASSERT(lag_s == 0 || tolerated_lag_s(plan, kStart, plan.sections.front().end) >= lag_s - 1e-5);
  }));
  EXPECT_GT(found_all, 20) << "of a hundred, most of which conflict";
}

}  // namespace
}  // namespace footlight::planner
