// SPDX-License-Identifier: Apache-2.0
#include "planner/way_in.hpp"

#include <algorithm>
#include <atomic>
#include <numeric>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <tbb/parallel_for.h>

#include "planner/validate.hpp"
#include "tests/support/plan_builder.hpp"

namespace footlight::planner {
namespace {

using tests::mark_at;
using tests::plan_of;
using Kind = WayIn::Kind;

constexpr double kBeat_s = 0.5;

std::vector<Instant> beats(int count, double first_s = 0) {
  std::vector<Instant> out;
  for (int k = 0; k < count; ++k) out.push_back(instant_at(first_s + k * kBeat_s));
  return out;
}

Plan stage_of(const Grid& grid, std::vector<std::vector<Mark>> tracks, double clearance_m, double last_s = 60) {
  Plan plan = plan_of(grid, std::move(tracks));
  plan.stage.clearance_m = clearance_m;
  plan.stage.max_speed_mps = 1.4;
  plan.sections.push_back({"all", kStart, instant_at(last_s), 1.4, {}, {}, {}});
  return plan;
}

Grid squares(int columns, int rows) { return *Grid::make(GridKind::square, columns, rows, 1.0); }

std::vector<Mark> stands(const Grid& grid, int column, int row, double last_s = 60) {
  return {mark_at(0, grid, column, row), mark_at(last_s, grid, column, row)};
}

/// The whole plan with somebody's own marks in the place of her track, then her track again.
Plan with_way(const Plan& plan, PerformerIndex who, const std::vector<Mark>& marks) {
  Plan out = plan;
  std::vector<Mark> track = marks;
  for (const Mark& mark : plan.tracks[who.at()]) {
    if (mark.time > track.back().time) track.push_back(mark);
  }
  out.tracks[who.at()] = track;
  return out;
}

/// Whether everybody's judge finds nothing that she has a part in while she is on her way.
bool judged(const Plan& plan, PerformerIndex who, const WayIn& answer) {
  Plan with = with_way(plan, who, answer.marks);
  if (answer.kind != Kind::join) with.tracks[who.at()] = answer.marks;
  const Verdict verdict = validate(with, answer.marks.front().time, answer.until);
  return std::none_of(verdict.first.begin(), verdict.first.end(),
                      [&](const Violation& one) { return one.a == who || one.b == who; });
}

struct Question {
  PerformerIndex who{0};
  CellIndex from;
  double earliest_s = 0;
  double latest_s = 60;
  std::vector<GivenWay> given{};
};

WayIn ask(const Plan& plan, const Question& question, int count = 64, double lag_s = 0) {
  const WaysIn ways(plan);
  const auto stretch = ways.stretch(beats(count), lag_s);
  return ways.find(*stretch, {question.who, question.from, instant_at(question.earliest_s),
                              instant_at(question.latest_s), plan.stage.max_speed_mps, question.given});
}

TEST(WayIn, WhoIsAloneGoesStraightToWhereSheIsSoonestOnHerOwnWalk) {
  const Grid grid = squares(20, 12);
  const Plan plan = stage_of(grid, {stands(grid, 15, 6)}, 0.5);
  const WayIn answer = ask(plan, {PerformerIndex(0), grid.index({5, 6}), 1.2});
  ASSERT_EQ(answer.kind, Kind::join);
  // 10 m at 1.4 m/s are 7.1 s: from the first beat after 1.2 s to the first one at which she can be there.
  EXPECT_EQ(answer.marks, (std::vector<Mark>{mark_at(1.5, grid, 5, 6), mark_at(9.0, grid, 15, 6)}));
  EXPECT_EQ(answer.until, instant_at(9.0));
}

TEST(WayIn, SheMeetsAWalkThatGoesOn) {
  const Grid grid = squares(20, 12);
  // Her own walk: 8 s to the left, a mark every 2 s, none of them on a beat.
  const Plan plan = stage_of(grid,
                             {{mark_at(0.1, grid, 18, 2), mark_at(2.1, grid, 16, 2), mark_at(4.1, grid, 14, 2),
                               mark_at(6.1, grid, 12, 2), mark_at(8.1, grid, 10, 2), mark_at(60, grid, 10, 2)}},
                             0.5);
  const WayIn answer = ask(plan, {PerformerIndex(0), grid.index({14, 6}), 0});
  ASSERT_EQ(answer.kind, Kind::join);
  EXPECT_EQ(answer.marks.back(), mark_at(4.1, grid, 14, 2));
  EXPECT_TRUE(judged(plan, PerformerIndex(0), answer));
}

TEST(WayIn, WhoIsWhereSheShouldBeIsOnHerWalkAtOnce) {
  const Grid grid = squares(6, 6);
  const Plan plan = stage_of(grid, {stands(grid, 2, 2), stands(grid, 3, 2)}, 0.5);
  const WayIn answer = ask(plan, {PerformerIndex(0), grid.index({2, 2}), 0});
  EXPECT_EQ(answer.kind, Kind::join);
  EXPECT_EQ(answer.marks, (std::vector<Mark>{mark_at(0, grid, 2, 2)}));
}

TEST(WayIn, AWallOfPeopleIsWalkedAround) {
  const Grid grid = squares(9, 9);
  std::vector<std::vector<Mark>> tracks{stands(grid, 6, 4)};
  for (int row = 0; row < 8; ++row) tracks.push_back(stands(grid, 4, row));
  const Plan plan = stage_of(grid, tracks, 0.8);  // nobody goes between two who stand a pitch apart
  const WayIn answer = ask(plan, {PerformerIndex(0), grid.index({2, 4}), 0});
  ASSERT_EQ(answer.kind, Kind::join);
  EXPECT_TRUE(judged(plan, PerformerIndex(0), answer));
  EXPECT_TRUE(std::any_of(answer.marks.begin(), answer.marks.end(), [&](const Mark& mark) {
    return grid.cell(mark.cell).row == 8;
  })) << "over the gap at the top";
}

TEST(WayIn, BlockedCellsAreWalkedAround) {
  const Grid grid = squares(9, 9);
  Plan plan = stage_of(grid, {stands(grid, 6, 4)}, 0.5);
  for (int row = 0; row < 8; ++row) plan.stage.blocked.push_back(grid.index({4, row}));
  const WayIn answer = ask(plan, {PerformerIndex(0), grid.index({2, 4}), 0});
  ASSERT_EQ(answer.kind, Kind::join);
  EXPECT_TRUE(judged(plan, PerformerIndex(0), answer));
  EXPECT_FALSE(WaysIn(plan).can_stand(grid.index({4, 3})));
}

TEST(WayIn, AnObstacleThatMovesIsLetPass) {
  const Grid grid = squares(15, 9);
  Plan plan = stage_of(grid, {stands(grid, 7, 7)}, 0.5);
  // A float 4 m wide that crosses between her and her place in the first 10 s.
  plan.sections[0].obstacles.push_back(
      {2.0, {{instant_at(0), {-3, 5}}, {instant_at(10), {3, 5}}, {instant_at(20), {12, 5}}}});
  const WayIn answer = ask(plan, {PerformerIndex(0), grid.index({7, 1}), 0});
  ASSERT_EQ(answer.kind, Kind::join);
  EXPECT_TRUE(judged(plan, PerformerIndex(0), answer));
}

TEST(WayIn, WhoIsShutInWaitsUntilTheRingOpensAndThenGoes) {
  const Grid grid = squares(15, 15);
  std::vector<std::vector<Mark>> tracks{stands(grid, 12, 7)};
  for (int column = 5; column <= 9; ++column) {
    for (int row = 5; row <= 9; ++row) {
      if (column > 5 && column < 9 && row > 5 && row < 9) continue;
      if (column == 9 && row == 7) {  // opens at 20 s
        tracks.push_back(
            {mark_at(0, grid, 9, 7), mark_at(20, grid, 9, 7), mark_at(24, grid, 11, 4), mark_at(60, grid, 11, 4)});
      } else {
        tracks.push_back(stands(grid, column, row));
      }
    }
  }
  const Plan plan = stage_of(grid, tracks, 0.9);
  const Question question{PerformerIndex(0), grid.index({7, 7}), 0};
  const WayIn early = ask(plan, question, 32);  // 15.5 s: it stays shut
  EXPECT_EQ(early.kind, Kind::wait);
  EXPECT_EQ(early.until, instant_at(15.5));
  EXPECT_TRUE(judged(plan, question.who, early));
  const WayIn later = ask(plan, question, 64);
  ASSERT_EQ(later.kind, Kind::join);
  EXPECT_GT(later.until, instant_at(20));
  EXPECT_TRUE(judged(plan, question.who, later));
}

TEST(WayIn, ThereIsNoWayThatIsTooFast) {
  const Grid grid = squares(20, 5);
  const Plan plan = stage_of(grid, {stands(grid, 19, 2)}, 0.5);
  const WayIn answer = ask(plan, {PerformerIndex(0), grid.index({0, 2}), 0, 10.0});  // 19 m in 10 s
  EXPECT_EQ(answer.kind, Kind::wait);
  EXPECT_EQ(answer.until, instant_at(10));
  EXPECT_EQ(ask(plan, {PerformerIndex(0), grid.index({0, 2}), 0, 14.0}).kind, Kind::join);
}

TEST(WayIn, HerOwnAndTheSectionsLimitOfSpeedHold) {
  const Grid grid = squares(20, 5);
  Plan plan = stage_of(grid, {stands(grid, 10, 2)}, 0.5);
  plan.sections[0].max_speed_mps = 0.5;
  const Question question{PerformerIndex(0), grid.index({0, 2}), 0};
  EXPECT_EQ(ask(plan, question).until, instant_at(20));
  plan.max_speed_mps[0] = 1.0;
  EXPECT_EQ(ask(plan, question).until, instant_at(10));
}

TEST(WayIn, WhoStandsInSomebodysWayStepsAside) {
  const Grid grid = squares(30, 5);
  // Her own place is out of reach; somebody walks along row 3 and over her cell at 10 s.
  const Plan plan =
      stage_of(grid,
               {stands(grid, 29, 4),
                {mark_at(0, grid, 0, 2), mark_at(5, grid, 0, 2), mark_at(15, grid, 10, 2), mark_at(60, grid, 10, 2)}},
               0.5);
  Question question{PerformerIndex(0), grid.index({5, 2}), 0, 8.0};
  EXPECT_EQ(ask(plan, question).kind, Kind::wait) << "until 8 s nobody comes";
  question.latest_s = 12;
  const WayIn aside = ask(plan, question);
  ASSERT_EQ(aside.kind, Kind::aside);
  EXPECT_EQ(aside.until, instant_at(12));
  EXPECT_NE(aside.marks.back().cell, question.from);
  EXPECT_NEAR(distance(grid.centre(aside.marks.back().cell), grid.centre(question.from)), 1, 1e-9);
  EXPECT_TRUE(judged(plan, question.who, aside));
}

TEST(WayIn, WhereSomebodyElseStandsThereIsNoAnswer) {
  const Grid grid = squares(6, 6);
  const Plan plan = stage_of(grid, {stands(grid, 5, 5), stands(grid, 2, 2)}, 0.5);
  EXPECT_EQ(ask(plan, {PerformerIndex(0), grid.index({2, 2}), 0}).kind, Kind::nowhere);
}

TEST(WayIn, TwoWhoAreLostAreKeptApart) {
  const Grid grid = squares(12, 3);
  // They should be where the other one is.
  const Plan plan = stage_of(grid, {stands(grid, 10, 1), stands(grid, 1, 1)}, 0.8);
  const WayIn first = ask(plan, {PerformerIndex(0), grid.index({1, 0}), 0});
  ASSERT_EQ(first.kind, Kind::join);
  const GivenWay given{PerformerIndex(0), first.marks};
  const WayIn second = ask(plan, {PerformerIndex(1), grid.index({9, 0}), 0, 60, {given}});
  ASSERT_EQ(second.kind, Kind::join);
  Plan both = with_way(with_way(plan, PerformerIndex(0), first.marks), PerformerIndex(1), second.marks);
  EXPECT_TRUE(validate(both, instant_at(0), second.until).valid());
}

TEST(WayIn, WhoMayBeLateKeepsFartherOff) {
  const Grid grid = squares(21, 5);
  // Somebody crosses her straight way to the right.
  const Plan plan =
      stage_of(grid,
               {stands(grid, 18, 2),
                {mark_at(0, grid, 10, 0), mark_at(2, grid, 10, 0), mark_at(6, grid, 10, 4), mark_at(60, grid, 10, 4)}},
               0.5);
  const Question question{PerformerIndex(0), grid.index({4, 2}), 0};
  const WayIn punctual = ask(plan, question);
  const WayIn late = ask(plan, question, 64, 1.0);
  ASSERT_EQ(punctual.kind, Kind::join);
  ASSERT_EQ(late.kind, Kind::join);
  const auto lag = [&](const WayIn& answer) {
    return tolerated_lag_s(with_way(plan, question.who, answer.marks), answer.marks.front().time, answer.until);
  };
  EXPECT_GE(lag(late), 1.0 - 1e-6);
  EXPECT_LT(lag(punctual), 1.0);
}

/// A few people on random walks that nothing keeps apart: what she is told must be clear all the same.
struct Crowd {
  explicit Crowd(std::uint64_t seed) {
    Rng rng(seed);
    const GridKind kinds[] = {GridKind::square, GridKind::hexagonal, GridKind::triangular};
    const Grid grid =
        *Grid::make(kinds[rng.below(3)], 9 + static_cast<int>(rng.below(6)), 7 + static_cast<int>(rng.below(5)), 1.0);
    plan = tests::random_plan(grid, 2 + rng.below(6), 8, rng.below(2) == 0, rng);
    plan.stage.clearance_m = 0.3 + 0.6 * rng.uniform();
    plan.stage.max_speed_mps = 1.0 + rng.uniform();
    if (rng.below(2) == 0) {
      for (double& radius : plan.radius_m) radius = 0.6 * rng.uniform();
    }
    if (rng.below(2) == 0) {
      for (const CellIndex cell : tests::random_cells(grid, 6, rng)) plan.stage.blocked.push_back(cell);
      std::sort(plan.stage.blocked.begin(), plan.stage.blocked.end());
    }
    plan.sections[0].max_speed_mps = 0;
    who = PerformerIndex::of(rng.below(plan.tracks.size()));
    from = CellIndex::of(rng.below(static_cast<std::uint64_t>(grid.size())));
    earliest = instant_at(8 * rng.uniform());
  }
  [[nodiscard]] WayInTask task() const { return {who, from, earliest, instant_at(13), plan.stage.max_speed_mps}; }
  Plan plan;
  PerformerIndex who;
  CellIndex from;
  Instant earliest;
};

TEST(WayIn, NoAnswerBreaksWhatTheJudgeHoldsEverybodyTo) {
  int joined = 0;
  int waited = 0;
  EXPECT_TRUE(rc::check([&] {
    const auto seed = *rc::gen::arbitrary<std::uint64_t>();
    const Crowd crowd(seed);
    const WaysIn ways(crowd.plan);
    if (!ways.can_stand(crowd.from)) return;
    const auto stretch = ways.stretch(beats(29), 0);
    const WayIn answer = ways.find(*stretch, crowd.task());
    if (answer.kind == Kind::nowhere) return;
    (answer.kind == Kind::join ? joined : waited) += 1;
    RC_ASSERT(answer.marks.front().cell == crowd.from);
    RC_ASSERT(answer.marks.front().time >= crowd.earliest);
    RC_ASSERT(answer.until <= instant_at(13));
    RC_ASSERT(judged(crowd.plan, crowd.who, answer));
  }));
  EXPECT_GT(joined, 5);
  EXPECT_GT(waited, 5);
}

TEST(WayIn, ManyWhoAskAtOnceGetWhatEachWouldGetAlone) {
  const Crowd crowd(7);
  const WaysIn ways(crowd.plan);
  const auto stretch = ways.stretch(beats(29), 0.2);
  const auto ask_from = [&](int cell) {
    WayInTask task = crowd.task();
    task.from = CellIndex::of(cell);
    return ways.can_stand(task.from) ? ways.find(*stretch, task) : WayIn{};
  };
  const int cells = crowd.plan.stage.grid.size();
  std::vector<WayIn> alone;
  for (int cell = 0; cell < cells; ++cell) alone.push_back(ask_from(cell));
  std::vector<WayIn> at_once(alone.size());
  tbb::parallel_for(0, cells, [&](int cell) { at_once[static_cast<std::size_t>(cell)] = ask_from(cell); });
  EXPECT_EQ(at_once, alone);
}

}  // namespace
}  // namespace footlight::planner
