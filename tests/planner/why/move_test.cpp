// SPDX-License-Identifier: Apache-2.0
#include "planner/why/move.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/planner/why/hurried_show.hpp"

namespace footlight::planner {
namespace {

using tests::HurriedShow;

TEST(ExplainMoves, NamesTheWalkItsTimeAndWhoseLimitHolds) {
  const HurriedShow made = tests::two_lists();
  const auto moves = explain_moves(made.show, made.plan, {}, PerformerIndex(0), FormationIndex(1), FormationIndex(1));
  ASSERT_EQ(moves.size(), 1U);
  const Move& move = moves.front();
  EXPECT_EQ(move.start, made.show.tempo.at(5));  // the hold of the section before is over
  EXPECT_EQ(move.end, made.show.tempo.at(9));
  EXPECT_EQ(made.show.stage.grid.name(move.from), "A1");
  EXPECT_EQ(made.show.stage.grid.name(move.to), "C1");
  EXPECT_DOUBLE_EQ(move.walk_m, 2);
  EXPECT_DOUBLE_EQ(move.fastest_mps, 1);  // 2 m in 4 counts of half a second
  EXPECT_EQ(move.whose_limit, Move::SpeedLimit::stage);
  EXPECT_DOUBLE_EQ(move.limit_mps, 1.4);
  EXPECT_FALSE(move.film_sets_time);
  EXPECT_EQ(move.bound, Move::Bound::list);
  EXPECT_FALSE(move.free_place.has_value());
}

TEST(ExplainMoves, AnOwnLimitComesBeforeTheSectionsAndThatBeforeTheStages) {
  HurriedShow made = tests::two_lists();
  made.show.sections[1].max_speed_mps = 1.2;
  made.plan.sections[1].max_speed_mps = 1.2;
  const auto limit = [&] {
    return explain_moves(made.show, made.plan, {}, PerformerIndex(0), FormationIndex(1), FormationIndex(1)).front();
  };
  EXPECT_EQ(limit().whose_limit, Move::SpeedLimit::section);
  EXPECT_DOUBLE_EQ(limit().limit_mps, 1.2);
  made.plan.max_speed_mps[0] = 1.1;
  EXPECT_EQ(limit().whose_limit, Move::SpeedLimit::own);
  EXPECT_DOUBLE_EQ(limit().limit_mps, 1.1);
}

TEST(ExplainMoves, NamesWhoComesNearestAndWhen) {
  const HurriedShow made = tests::two_lists();
  const auto move =
      explain_moves(made.show, made.plan, {}, PerformerIndex(0), FormationIndex(1), FormationIndex(1)).front();
  ASSERT_TRUE(move.nearest.has_value());
  // Performer 2 waits on B2 and is passed half-way, a metre away; performer 3 is ten metres off.
  EXPECT_EQ(move.nearest->who, PerformerIndex(1));
  EXPECT_NEAR(move.nearest->distance_m, 1, 1e-12);
  EXPECT_DOUBLE_EQ(move.nearest->least_m, 0.5);
  EXPECT_EQ(move.nearest->at, made.show.tempo.at(7));
  EXPECT_DOUBLE_EQ(move.tolerated_lag_s, 2);
  EXPECT_FALSE(move.lag_limited_by.has_value());
}

TEST(ExplainMoves, NamesWhoIsMetFirstByWhoIsLate) {
  HurriedShow made = tests::two_lists();
  // Performer 2 comes down on A1 when she is on C1: two metres apart when both are on time.
  const Grid& grid = made.show.stage.grid;
  made.plan.tracks[1] = {{made.show.tempo.at(1), grid.index({0, 2})},
                         {made.show.tempo.at(5), grid.index({0, 2})},
                         {made.show.tempo.at(9), grid.index({0, 0})}};
  const auto move =
      explain_moves(made.show, made.plan, {}, PerformerIndex(0), FormationIndex(1), FormationIndex(1)).front();
  ASSERT_TRUE(move.lag_limited_by.has_value());
  EXPECT_EQ(*move.lag_limited_by, PerformerIndex(1));
  // Perpendicular at 1 m/s, 2 m apart: late by L, the least distance is (2 - L) / sqrt(2) = 0.5 at L = 1.293.
  EXPECT_NEAR(move.tolerated_lag_s, 2 - 0.5 * std::sqrt(2.0), 1e-4);
}

TEST(ExplainMoves, MeasuresTheBlockedCellNearestToTheWay) {
  HurriedShow made = tests::two_lists();
  made.plan.stage.blocked = {made.show.stage.grid.index({1, 2}), made.show.stage.grid.index({9, 9})};
  const auto move =
      explain_moves(made.show, made.plan, {}, PerformerIndex(0), FormationIndex(1), FormationIndex(1)).front();
  EXPECT_FALSE(move.blocked.has_value());  // 1.5 m away: more than a pitch above the limit
  made.plan.stage.blocked = {made.show.stage.grid.index({1, 1}), made.show.stage.grid.index({9, 9})};
  const auto near =
      explain_moves(made.show, made.plan, {}, PerformerIndex(0), FormationIndex(1), FormationIndex(1)).front();
  ASSERT_TRUE(near.blocked.has_value());
  EXPECT_EQ(made.show.stage.grid.name(near.blocked->cell), "B2");
  EXPECT_DOUBLE_EQ(near.blocked->distance_m, 0.5);
  EXPECT_DOUBLE_EQ(near.blocked->least_m, 0.25);
}

TEST(ExplainMoves, TellsThePlaceThatWasTooFarAway) {
  const HurriedShow made = tests::jumping_film();
  int late = 0;
  for (std::uint32_t p = 0; p < made.plan.tracks.size(); ++p) {
    const auto moves = explain_moves(made.show, made.plan, made.film, PerformerIndex(p), FormationIndex(1),
                                     FormationIndex::of(made.plan.formations.size() - 1));
    ASSERT_EQ(moves.size(), made.plan.formations.size() - 1);
    for (const Move& move : moves) {
      EXPECT_TRUE(move.film_sets_time);
      EXPECT_LE(move.fastest_mps, move.limit_mps * (1 + 1e-6));
      if (!move.free_place) continue;
      ++late;
      EXPECT_GT(move.free_place->away_m, 0);
      EXPECT_NE(move.free_place->cell, move.to);
    }
  }
  EXPECT_GT(late, 0);
}

TEST(ExplainMoves, WorksForOnePerformerAlone) {
  HurriedShow made = tests::two_lists();
  made.plan.tracks.resize(1);
  made.plan.performers.resize(1);
  for (Formation& formation : made.plan.formations) formation.cells.resize(1);
  const auto move =
      explain_moves(made.show, made.plan, {}, PerformerIndex(0), FormationIndex(1), FormationIndex(1)).front();
  EXPECT_FALSE(move.nearest.has_value());
  EXPECT_DOUBLE_EQ(move.tolerated_lag_s, 2);
}

TEST(ExplainMoves, NamesWhatKeepsOthersOffHerPlace) {
  HurriedShow made = tests::two_lists();
  made.show.groups.push_back({"left", {}, false});
  made.show.performers[1].group = GroupIndex(0);
  auto& there = std::get<CellsSource>(made.show.sections[1].from);
  there.assigned = false;
  Override hand;
  hand.number = 1;
  hand.pin = {{PerformerIndex(2), there.cells[2], {}}};
  made.show.sections[1].overrides = {hand};
  const auto bound = [&](std::uint32_t who) {
    return explain_moves(made.show, made.plan, {}, PerformerIndex(who), FormationIndex(1), FormationIndex(1)).front();
  };
  EXPECT_EQ(bound(0).bound, Move::Bound::nothing);
  EXPECT_EQ(bound(1).bound, Move::Bound::group);
  EXPECT_EQ(bound(1).group, GroupIndex(0));
  EXPECT_EQ(bound(2).bound, Move::Bound::pin);
  EXPECT_EQ(bound(2).pinned_to, there.cells[2]);
  EXPECT_TRUE(bound(2).exact);
  there.groups = {std::nullopt, GroupIndex(0), std::nullopt};
  EXPECT_EQ(bound(1).bound, Move::Bound::group_in_list);
  there.groups.clear();
  made.show.sections[1].regions.push_back({GroupIndex(0), {there.cells[1]}, {}});
  EXPECT_EQ(bound(1).bound, Move::Bound::region);
  EXPECT_EQ(bound(0).bound, Move::Bound::nothing);
}

}  // namespace
}  // namespace footlight::planner
