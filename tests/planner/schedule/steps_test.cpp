// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/steps.hpp"

#include <algorithm>
#include <queue>
#include <set>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "planner/repair/closest_approach.hpp"
#include "planner/schedule/step_distance.hpp"
#include "tests/support/plan_builder.hpp"

namespace footlight::planner {
namespace {

Stage stage_of(GridKind kind, int columns, int rows, std::vector<CellIndex> blocked = {}) {
  Stage stage;
  stage.grid = Grid::make(kind, columns, rows, 1.0).value();
  std::sort(blocked.begin(), blocked.end());
  stage.blocked = std::move(blocked);
  return stage;
}

std::vector<CellIndex> cells_of(const Grid& grid, const std::vector<Cell>& cells) {
  std::vector<CellIndex> out;
  for (const Cell cell : cells) out.push_back(grid.index(cell));
  return out;
}

Ways ways_of(const Stage& stage) { return {stage, stage.clearance_m / 2}; }

/// Where everybody is at every step, after checking that each step may be walked: neighbouring cells, one person a
/// cell, and nobody nearer to anybody than the grid's bound.
std::vector<std::vector<CellIndex>> walked(const StepsTask& task, const Steps& steps) {
  const Grid& grid = task.ways->grid();
  std::vector<std::vector<CellIndex>> at{{task.from.begin(), task.from.end()}};
  EXPECT_EQ(steps.first.back(), steps.moves.size());
  for (int step = 0; step < steps.count(); ++step) {
    at.push_back(at.back());
    std::set<std::uint32_t> moved;
    const auto n = static_cast<std::size_t>(step);
    for (std::uint32_t m = steps.first[n]; m < steps.first[n + 1]; ++m) {
      const Steps::Move& move = steps.moves[m];
      EXPECT_TRUE(moved.insert(move.person).second) << "twice in a step";
      const auto near = grid.neighbours(at.back()[move.person]);
      EXPECT_TRUE(std::find(near.begin(), near.end(), move.cell) != near.end()) << "no neighbour";
      EXPECT_TRUE(task.ways->can_stand(move.cell));
      at.back()[move.person] = move.cell;
    }
    EXPECT_EQ(std::set<CellIndex>(at.back().begin(), at.back().end()).size(), task.from.size()) << "shared cell";
    std::vector<Walk> walks;
    for (std::size_t i = 0; i < task.from.size(); ++i) {
      walks.push_back({grid.centre(at[n][i]), grid.centre(at[n + 1][i])});
    }
    EXPECT_TRUE(near_pairs(walks, grid.clearance_bound_m() - 1e-9).empty()) << "too near in step " << step;
  }
  EXPECT_EQ(at.back(), steps.last);
  std::vector<std::uint32_t> targets = steps.target_of;
  std::sort(targets.begin(), targets.end());
  for (std::uint32_t i = 0; i < targets.size(); ++i) EXPECT_EQ(targets[i], i) << "no bijection";
  if (steps.arrived) {
    for (std::size_t i = 0; i < targets.size(); ++i) EXPECT_EQ(steps.last[i], task.to[steps.target_of[i]]);
  }
  return at;
}

TEST(StepDistance, IsTheNumberOfStepsOverNeighboursOnEveryGrid) {
  for (const GridKind kind : {GridKind::square, GridKind::hexagonal, GridKind::triangular}) {
    const Grid grid = Grid::make(kind, 9, 8, 1.0).value();
    for (int start = 0; start < grid.size(); ++start) {
      std::vector<int> steps(static_cast<std::size_t>(grid.size()), -1);
      std::queue<CellIndex> open;
      open.push(CellIndex::of(start));
      steps[open.front().at()] = 0;
      while (!open.empty()) {
        const CellIndex cell = open.front();
        open.pop();
        EXPECT_EQ(steps_between(kind, grid.cell(CellIndex::of(start)), grid.cell(cell)), steps[cell.at()])
            << to_text(kind) << " " << grid.name(CellIndex::of(start)) << " " << grid.name(cell);
        for (const CellIndex next : grid.neighbours(cell)) {
          if (steps[next.at()] >= 0) continue;
          steps[next.at()] = steps[cell.at()] + 1;
          open.push(next);
        }
      }
    }
  }
}

TEST(StepThrough, NarrowStagesAreWalkedRight) {
  for (const GridKind kind : {GridKind::square, GridKind::hexagonal, GridKind::triangular}) {
    for (const int columns : {1, 2, 3}) {
      const Stage stage = stage_of(kind, columns, 3);
      const Ways ways = ways_of(stage);
      for (int a = 0; a < stage.grid.size(); ++a) {
        for (int b = 0; b < stage.grid.size(); ++b) {
          if (columns == 1 && kind == GridKind::triangular) continue;  // such cells hang together in pairs only
          const std::vector<CellIndex> from{CellIndex::of(a)};
          const std::vector<CellIndex> to{CellIndex::of(b)};
          const auto steps = step_through({&ways, from, to, 50, {}}).value();
          EXPECT_TRUE(steps.arrived);
          EXPECT_EQ(steps.count(), steps_between(kind, stage.grid.cell(from[0]), stage.grid.cell(to[0])));
          walked({&ways, from, to, 50, {}}, steps);
        }
      }
    }
  }
}

TEST(StepThrough, WalksOneCellAStep) {
  const Stage stage = stage_of(GridKind::square, 6, 4);
  const Ways ways = ways_of(stage);
  const auto from = cells_of(stage.grid, {{0, 0}});
  const auto to = cells_of(stage.grid, {{4, 2}});
  const auto steps = step_through({&ways, from, to, 100, {}}).value();
  EXPECT_TRUE(steps.arrived);
  EXPECT_EQ(steps.count(), 6);
  EXPECT_EQ(walked({&ways, from, to, 100, {}}, steps).back(), to);
}

TEST(StepThrough, ATrainMovesTogether) {
  const Stage stage = stage_of(GridKind::square, 8, 1);
  const Ways ways = ways_of(stage);
  const auto from = cells_of(stage.grid, {{2, 0}, {1, 0}, {0, 0}});
  const auto to = cells_of(stage.grid, {{7, 0}, {6, 0}, {5, 0}});
  const auto steps = step_through({&ways, from, to, 100, {}}).value();
  EXPECT_EQ(steps.count(), 5);
  EXPECT_EQ(steps.moves.size(), 15U);
  walked({&ways, from, to, 100, {}}, steps);
}

TEST(StepThrough, WhoStandsInTheWayAtHerGoalTakesTheWayOver) {
  const Stage stage = stage_of(GridKind::square, 5, 1);
  const Ways ways = ways_of(stage);
  const auto from = cells_of(stage.grid, {{0, 0}, {2, 0}});
  const auto to = cells_of(stage.grid, {{4, 0}, {2, 0}});
  const auto steps = step_through({&ways, from, to, 100, {}}).value();
  EXPECT_TRUE(steps.arrived);
  EXPECT_EQ(steps.target_of, (std::vector<std::uint32_t>{1, 0}));
  EXPECT_EQ(steps.last, cells_of(stage.grid, {{2, 0}, {4, 0}}));
  walked({&ways, from, to, 100, {}}, steps);
}

TEST(StepThrough, TwoWhoWantEachOthersCellsStayAndAreDone) {
  const Stage stage = stage_of(GridKind::square, 2, 2);
  const Ways ways = ways_of(stage);
  const auto all = cells_of(stage.grid, {{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  for (const auto& to : {cells_of(stage.grid, {{1, 0}, {0, 0}, {1, 1}, {0, 1}}),
                         cells_of(stage.grid, {{1, 0}, {1, 1}, {0, 1}, {0, 0}})}) {
    const auto steps = step_through({&ways, all, to, 100, {}}).value();
    EXPECT_TRUE(steps.arrived);
    EXPECT_TRUE(steps.moves.empty());
    walked({&ways, all, to, 100, {}}, steps);
  }
}

TEST(StepThrough, IsCutWhenTheStepsAreTooFew) {
  const Stage stage = stage_of(GridKind::square, 8, 1);
  const Ways ways = ways_of(stage);
  const auto from = cells_of(stage.grid, {{0, 0}, {6, 0}});
  const auto to = cells_of(stage.grid, {{5, 0}, {7, 0}});
  const auto steps = step_through({&ways, from, to, 3, {}}).value();
  EXPECT_FALSE(steps.arrived);
  EXPECT_EQ(steps.count(), 3);
  EXPECT_EQ(steps.last, cells_of(stage.grid, {{3, 0}, {7, 0}}));
}

TEST(StepThrough, GoesAroundBlockedCellsAndSaysWhenThereIsNoWay) {
  Stage stage = stage_of(GridKind::square, 7, 5);
  for (int row = 0; row < 4; ++row) stage.blocked.push_back(stage.grid.index({3, row}));
  std::sort(stage.blocked.begin(), stage.blocked.end());
  const auto from = cells_of(stage.grid, {{0, 0}, {1, 0}, {2, 0}});
  const auto to = cells_of(stage.grid, {{4, 0}, {5, 0}, {6, 0}});
  const Ways ways = ways_of(stage);
  const auto steps = step_through({&ways, from, to, 100, {}}).value();
  EXPECT_TRUE(steps.arrived);
  EXPECT_EQ(steps.count(), 12);
  walked({&ways, from, to, 100, {}}, steps);
  stage.blocked.push_back(stage.grid.index({3, 4}));
  const Ways wall = ways_of(stage);
  EXPECT_FALSE(step_through({&wall, from, to, 100, {}}).has_value());
}

TEST(StepThrough, KindsExchangeAmongThemselvesOnly) {
  const Stage stage = stage_of(GridKind::square, 5, 2);
  const Ways ways = ways_of(stage);
  const auto from = cells_of(stage.grid, {{0, 0}, {2, 0}});
  const auto to = cells_of(stage.grid, {{4, 0}, {2, 0}});
  const std::vector<std::uint32_t> names{0, 1};
  const StepsTask named{&ways, from, to, 100, names};
  const auto pushed = step_through(named).value();
  EXPECT_TRUE(pushed.arrived);
  EXPECT_EQ(pushed.target_of, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(walked(named, pushed).back(), to);
  const std::vector<std::uint32_t> alike{7, 7};
  EXPECT_EQ(step_through({&ways, from, to, 100, alike})->target_of, (std::vector<std::uint32_t>{1, 0}));
}

TEST(StepThrough, NamedPeopleWhereNobodyCanStepAsideDoNotArriveAndStayClear) {
  const Stage stage = stage_of(GridKind::square, 5, 1);
  const Ways ways = ways_of(stage);
  const auto from = cells_of(stage.grid, {{0, 0}, {2, 0}});
  const auto to = cells_of(stage.grid, {{4, 0}, {2, 0}});
  const std::vector<std::uint32_t> names{0, 1};
  const StepsTask task{&ways, from, to, 100'000, names};
  const auto steps = step_through(task).value();
  EXPECT_FALSE(steps.arrived);
  walked(task, steps);
}

/// Two blocks of people with names change sides, on every grid, with a set piece between them.
TEST(StepThrough, NamedPeoplePassThroughEachOther) {
  for (const GridKind kind : {GridKind::square, GridKind::hexagonal, GridKind::triangular}) {
    Stage stage = stage_of(kind, 20, 14);
    for (int row = 6; row < 8; ++row) stage.blocked.push_back(stage.grid.index({10, row}));
    const Ways ways = ways_of(stage);
    std::vector<Cell> left;
    std::vector<Cell> right;
    for (int row = 3; row < 11; ++row) {
      for (int column = 1; column < 5; ++column) {
        left.push_back({column, row});
        right.push_back({column + 14, row});
      }
    }
    std::vector<CellIndex> from = cells_of(stage.grid, left);
    std::vector<CellIndex> to = cells_of(stage.grid, right);
    const auto others = from;
    from.insert(from.end(), to.begin(), to.end());
    to.insert(to.end(), others.begin(), others.end());
    std::vector<std::uint32_t> names;
    for (std::uint32_t i = 0; i < from.size(); ++i) names.push_back(i);
    const StepsTask task{&ways, from, to, 100'000, names};
    const auto steps = step_through(task).value();
    // Three neighbours leave such a crowd too little room; it stays clear all the same.
    EXPECT_TRUE(steps.arrived || kind == GridKind::triangular) << to_text(kind) << " after " << steps.count();
    EXPECT_EQ(steps.target_of, names);
    walked(task, steps);
  }
}

/// Who is late by 0.3 of a step comes no nearer than the clearance to whoever is ahead or behind.
TEST(StepThrough, FollowsNoCloserThanLatenessAllows) {
  const Stage stage = stage_of(GridKind::square, 12, 12);
  const Ways ways = ways_of(stage);
  Rng rng(5);
  auto cells = tests::random_cells(stage.grid, 144, rng);
  const std::vector<CellIndex> from(cells.begin(), cells.begin() + 60);
  const std::vector<CellIndex> to(cells.begin() + 50, cells.begin() + 110);
  for (const double late_share : {0.0, 0.3}) {
    StepsTask task{&ways, from, to, 100'000, {}};
    task.clearance_m = 0.6;
    task.late_share = late_share;
    const auto steps = step_through(task).value();
    EXPECT_TRUE(steps.arrived);
    const auto at = walked(task, steps);
    bool turned = false;
    for (std::size_t n = 1; n < at.size(); ++n) {
      for (std::size_t i = 0; i < from.size(); ++i) {
        for (std::size_t j = 0; j < from.size(); ++j) {
          if (i == j || at[n][i] != at[n - 1][j] || at[n][i] == at[n - 1][i]) continue;
          const Point mine = stage.grid.centre(at[n][i]) - stage.grid.centre(at[n - 1][i]);
          turned = turned || dot(mine, stage.grid.centre(at[n][j]) - stage.grid.centre(at[n - 1][j])) < 0.5;
        }
      }
    }
    EXPECT_EQ(turned, late_share == 0.0);
  }
}

/// Any crowd on any grid, with blocked cells or without, densely or thinly: everybody arrives, and every step is clear.
TEST(StepThrough, EverybodyArrivesAndEveryStepIsClear) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::inRange<std::uint64_t>(1, 1'000'000'000));
    const GridKind kind = *rc::gen::element(GridKind::square, GridKind::hexagonal, GridKind::triangular);
    Stage stage = stage_of(kind, *rc::gen::inRange(2, 14), *rc::gen::inRange(2, 14));
    const auto some = static_cast<std::size_t>(stage.grid.size());
    auto cells = tests::random_cells(stage.grid, some, rng);
    if (*rc::gen::inRange(0, 2) == 1) {
      stage.blocked.assign(cells.begin(), cells.begin() + static_cast<std::ptrdiff_t>(rng.below(some / 8 + 1)));
      std::sort(stage.blocked.begin(), stage.blocked.end());
    }
    const Ways ways = ways_of(stage);
    std::vector<CellIndex> free;
    for (const CellIndex cell : cells) {
      if (ways.can_stand(cell)) free.push_back(cell);
    }
    const std::size_t people = free.empty() ? 0 : 1 + rng.below(free.size());
    const std::vector<CellIndex> from(free.begin(), free.begin() + static_cast<std::ptrdiff_t>(people));
    for (std::size_t i = 0; i + 1 < free.size(); ++i) std::swap(free[i], free[i + rng.below(free.size() - i)]);
    const std::vector<CellIndex> to(free.begin(), free.begin() + static_cast<std::ptrdiff_t>(people));
    const StepsTask task{&ways, from, to, 100'000, {}};
    const auto steps = step_through(task);
    if (!steps) RC_DISCARD("no way");
    RC_ASSERT(steps->arrived);
    RC_ASSERT(!testing::Test::HasFailure());
    walked(task, *steps);
    RC_ASSERT(!testing::Test::HasFailure());
    const auto again = step_through(task);
    RC_ASSERT(again->last == steps->last);
    RC_ASSERT(again->moves.size() == steps->moves.size());
  }));
}

}  // namespace
}  // namespace footlight::planner
