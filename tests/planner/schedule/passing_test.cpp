// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/passing.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"
#include "planner/repair/closest_approach.hpp"
#include "planner/repair/lateness.hpp"
#include "tests/planner/random_places.hpp"

namespace footlight::planner {
namespace {

std::vector<std::uint32_t> names(std::size_t people) {
  std::vector<std::uint32_t> out(people);
  std::iota(out.begin(), out.end(), 0U);
  return out;
}

/// What is wrong with it: people on one cell, walks too long or not straight, pairs too near, somebody not at a target
/// of her kind. Empty: nothing.
std::string wrong_with(const PassTask& task, const Passing& passing) {
  const Grid& grid = task.ways->grid();
  if (!std::equal(passing.at.front().begin(), passing.at.front().end(), task.from.begin())) return "starts elsewhere";
  for (std::size_t step = 1; step < passing.at.size(); ++step) {
    const auto& now = passing.at[step - 1];
    const auto& next = passing.at[step];
    if (std::set<CellIndex>(next.begin(), next.end()).size() != next.size()) return "two on one cell";
    std::vector<Walk> walks;
    for (std::size_t i = 0; i < next.size(); ++i) {
      walks.push_back({grid.centre(now[i]), grid.centre(next[i])});
      if (distance(walks.back().from, walks.back().to) > passing.longest_m[step - 1] + 1e-9) return "too long a walk";
      if (!task.ways->straight(walks.back().from, walks.back().to)) return "into a blocked cell";
    }
    // All pairs, without the tree that the planner uses.
    for (std::size_t a = 0; a < walks.size(); ++a) {
      for (std::size_t b = a + 1; b < walks.size(); ++b) {
        if (closest_approach(walks[a], walks[b]).distance_m < task.clearance_m - 1e-6) return "too near";
      }
    }
  }
  std::vector<std::uint32_t> taken = passing.target_of;
  std::sort(taken.begin(), taken.end());
  if (taken != names(task.from.size())) return "no bijection";
  for (std::size_t i = 0; i < task.from.size(); ++i) {
    const std::uint32_t target = passing.target_of[i];
    if (passing.at.back()[i] != task.to[target]) return "not at the target";
    if (!task.kind.empty() && task.kind[target] != task.kind[i]) return "another kind's target";
  }
  const double sum = std::accumulate(passing.longest_m.begin(), passing.longest_m.end(), 0.0);
  return std::abs(sum / task.speed_mps - passing.needed_s) < 1e-9 ? "" : "another time than it says";
}

class Pass : public testing::Test {
 protected:
  explicit Pass(GridKind kind = GridKind::square) { stage_.grid = *Grid::make(kind, 14, 12, 1.0); }
  [[nodiscard]] CellIndex cell(int column, int row) const { return stage_.grid.index({column, row}); }
  Stage stage_;
};

TEST_F(Pass, TwoNamedPeopleExchangeTheirPlacesAlongOneLine) {
  const Ways ways(stage_, 0.25);
  const std::vector<CellIndex> from{cell(2, 5), cell(9, 5)};
  const std::vector<CellIndex> to{cell(9, 5), cell(2, 5)};
  const auto kind = names(2);
  const PassTask task{&ways, from, to, kind, 0.5, 1.4, 10, 0.2};
  const auto found = pass(task, {});
  ASSERT_TRUE(found);
  EXPECT_EQ(wrong_with(task, *found), "");
  EXPECT_LE(found->needed_s, 1.5 * 7 / 1.4);
  EXPECT_TRUE(found->tolerates_lag);
  EXPECT_LE(found->at.size(), 5U) << "marks are few: walks of three pitches";
}

TEST_F(Pass, ADenseBlockWhosePeopleAreAllPermuted) {
  const Ways ways(stage_, 0.25);
  std::vector<CellIndex> from;
  for (int row = 3; row < 9; ++row) {
    for (int column = 4; column < 10; ++column) from.push_back(cell(column, row));
  }
  std::vector<CellIndex> to(from.rbegin(), from.rend());
  const auto kind = names(36);
  const PassTask task{&ways, from, to, kind, 0.5, 1.4, 60, 0};
  const auto found = pass(task, {});
  ASSERT_TRUE(found);
  EXPECT_EQ(wrong_with(task, *found), "");
}

TEST_F(Pass, AroundASetPiece) {
  for (int row = 2; row < 10; ++row) stage_.blocked.push_back(cell(6, row));
  const Ways ways(stage_, 0.25);
  std::vector<CellIndex> from;
  std::vector<CellIndex> to;
  for (int row = 3; row < 9; ++row) {
    from.push_back(cell(3, row));
    to.push_back(cell(9, 11 - row));
    from.push_back(cell(9, row));
    to.push_back(cell(3, 11 - row));
  }
  const auto kind = names(12);
  const PassTask task{&ways, from, to, kind, 0.5, 1.4, 60, 0};
  const auto found = pass(task, {});
  ASSERT_TRUE(found);
  EXPECT_EQ(wrong_with(task, *found), "");
}

TEST_F(Pass, SaysWhatTimeWouldDoWhereThereIsTooLittle) {
  const Ways ways(stage_, 0.25);
  const std::vector<CellIndex> from{cell(2, 5), cell(9, 5), cell(0, 0)};
  const std::vector<CellIndex> to{cell(9, 5), cell(2, 5), cell(0, 0)};
  const auto kind = names(3);
  const PassTask task{&ways, from, to, kind, 0.5, 1.4, 5, 0};  // the straight way alone takes 5 s
  const auto found = pass(task, {});
  ASSERT_TRUE(found);
  EXPECT_GT(found->needed_s, 5);
  EXPECT_LT(found->last, 2U);
  EXPECT_EQ(wrong_with(task, *found), "");
}

TEST_F(Pass, WhoIsWalledInOrHasNoRoomToPassIsNotFound) {
  for (int row = 0; row < 12; ++row) stage_.blocked.push_back(cell(6, row));
  const Ways walled(stage_, 0.25);
  const std::vector<CellIndex> from{cell(2, 5)};
  const std::vector<CellIndex> to{cell(9, 5)};
  EXPECT_FALSE(pass({&walled, from, to, {}, 0.5, 1.4, 60, 0}, {}));
  Stage corridor;
  corridor.grid = *Grid::make(GridKind::square, 8, 1, 1.0);
  const Ways narrow(corridor, 0.25);
  const std::vector<CellIndex> ends{CellIndex(0), CellIndex(7)};
  const std::vector<CellIndex> other{CellIndex(7), CellIndex(0)};
  const auto kind = names(2);
  EXPECT_FALSE(pass({&narrow, ends, other, kind, 0.5, 1.4, 60, 0}, {}));
  EXPECT_TRUE(pass({&narrow, ends, other, {}, 0.5, 1.4, 60, 0}, {})) << "who may exchange need not pass";
}

TEST_F(Pass, WhateverIsFoundIsClearAndKeepsTheKinds) {
  int found_all = 0;
  EXPECT_TRUE(rc::check([&] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    Stage stage;
    stage.grid = *Grid::make(static_cast<GridKind>(rng.below(3)), 9, 8, 1.0);
    if (rng.below(3) == 0) stage.blocked = {CellIndex(31), CellIndex(32)};
    const Ways ways(stage, 0.25);
    const std::size_t people = 1 + rng.below(40);
    const auto from = random_places(ways, people, rng);
    const auto to = random_places(ways, people, rng);
    const auto kind = random_kinds(people, rng);
    const double clearances[] = {0.3, 0.5, 0.7, 0.9};
    const PassTask task{&ways, from, to, kind, clearances[rng.below(4)], 1.4, 30, rng.below(2) == 0 ? 0.0 : 0.2};
    const auto found = pass(task, {});
    if (!found) return;
    ++found_all;
    const std::string wrong = wrong_with(task, *found);
    if (!wrong.empty()) RC_FAIL(wrong);
  }));
  EXPECT_GT(found_all, 50) << "of a hundred, some without room to pass";
}

TEST_F(Pass, StopsWhenToldTo) {
  const Ways ways(stage_, 0.25);
  const std::vector<CellIndex> from{cell(2, 5), cell(9, 5)};
  const std::vector<CellIndex> to{cell(9, 5), cell(2, 5)};
  const std::atomic<bool> stop{true};
  EXPECT_FALSE(pass({&ways, from, to, {}, 0.5, 1.4, 10, 0.2}, {{}, &stop}));
}

}  // namespace
}  // namespace footlight::planner
