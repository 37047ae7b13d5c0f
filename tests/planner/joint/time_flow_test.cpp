// SPDX-License-Identifier: Apache-2.0
#include "planner/joint/time_flow.hpp"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"

namespace footlight::planner {
namespace {

/// Cells in a row; one step to either side, or stay.
Reach row_of(std::uint32_t cells, std::uint64_t seed) {
  Rng rng(seed);
  Reach reach;
  for (std::uint32_t c = 0; c < cells; ++c) {
    reach.first.push_back(static_cast<std::uint32_t>(reach.to.size()));
    for (std::uint32_t to = c == 0 ? 0 : c - 1; to <= std::min(c + 1, cells - 1); ++to) reach.to.push_back(to);
  }
  reach.first.push_back(static_cast<std::uint32_t>(reach.to.size()));
  // Kinds come in pairs, one for each way; the way there decides for the way back.
  for (std::size_t kind = 0; kind < reach.mirror.size(); ++kind) {
    reach.mirror[kind] = static_cast<std::uint8_t>(kind ^ 1U);
  }
  std::vector<std::uint8_t> right(cells);
  for (std::uint8_t& kind : right) kind = static_cast<std::uint8_t>(rng.below(120));
  for (std::uint32_t c = 0; c < cells; ++c) {
    for (std::uint32_t a = reach.first[c]; a < reach.first[c + 1]; ++a) {
      const std::uint32_t to = reach.to[a];
      const std::uint8_t kind = right[std::min(c, to)];
      reach.kind.push_back(to == c ? 240 : static_cast<std::uint8_t>(to > c ? kind : kind ^ 1U));
    }
  }
  reach.mirror[240] = 240;
  return reach;
}

FlowTask random_task(const Reach& reach, std::uint32_t cells, std::size_t people, std::size_t intervals, bool placed,
                     std::uint64_t seed) {
  Rng rng(seed);
  const auto cost = [&] { return static_cast<std::int32_t>(rng.below(41)) - 20; };
  FlowTask task;
  task.cells = cells;
  task.people = people;
  for (std::size_t i = 0; placed && i < people; ++i) task.start.push_back(CellIndex::of(i));
  for (std::size_t k = 0; k < intervals; ++k) {
    FlowInterval interval{&reach, {}};
    for (std::int32_t& of_kind : interval.cost) of_kind = cost();
    task.intervals.push_back(interval);
  }
  for (std::size_t v = 0; v < cells * (intervals + 1); ++v) task.stand.push_back(cost());
  return task;
}

std::optional<TimeFlow> solve(const FlowTask& task, std::initializer_list<std::int32_t> epsilons) {
  TimeFlowSolver solver(task);
  for (const std::int32_t epsilon : epsilons) {
    if (!solver.refine(epsilon, {})) return std::nullopt;
  }
  return solver.result();
}

/// Every plan of two people, one after the other.
std::int64_t least_of_all(const FlowTask& task, std::size_t k, std::uint32_t a, std::uint32_t b) {
  const std::int64_t here = std::int64_t{task.stand[k * task.cells + a]} + task.stand[k * task.cells + b];
  if (k == task.intervals.size()) return here;
  const FlowInterval& interval = task.intervals[k];
  const Reach& reach = *interval.reach;
  std::int64_t least = 1'000'000;
  for (std::uint32_t i = reach.first[a]; i < reach.first[a + 1]; ++i) {
    for (std::uint32_t j = reach.first[b]; j < reach.first[b + 1]; ++j) {
      if (reach.to[i] == reach.to[j]) continue;
      least = std::min(least, interval.cost[reach.kind[i]] + interval.cost[reach.kind[j]] +
                                  least_of_all(task, k + 1, reach.to[i], reach.to[j]));
    }
  }
  return here + least;
}

/// At epsilon 1 costs are whole and small: within two a person and interval of the least.
/// Everybody's way has an arc in, one through each instant's cell, one for each walk and one out; rounding costs and
/// prices to whole epsilons may cost two of one epsilon on each.
std::int64_t widest_gap(std::size_t people, std::size_t intervals) {
  return static_cast<std::int64_t>(2 * people * (2 * (intervals + 1) + 1));
}

TEST(TimeFlow, CostsHardlyMoreThanAnyPlanOfTwoPeople) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const Reach reach = row_of(5, seed);
    const FlowTask placed = random_task(reach, 5, 2, 4, true, seed);
    const FlowTask free = random_task(reach, 5, 2, 4, false, seed);
    std::int64_t best_free = 1'000'000;
    for (std::uint32_t a = 0; a < 5; ++a) {
      for (std::uint32_t b = a + 1; b < 5; ++b) best_free = std::min(best_free, least_of_all(free, 0, a, b));
    }
    for (const auto& [task, best] : {std::pair{placed, least_of_all(placed, 0, 0, 1)}, std::pair{free, best_free}}) {
      const auto flow = solve(task, {16, 4, 1});
      ASSERT_TRUE(flow);
      EXPECT_GE(flow->cost, best) << "seed " << seed;
      EXPECT_LE(flow->cost, best + 16) << "seed " << seed;
      EXPECT_LE(flow->bound, best) << "seed " << seed;
    }
  }
}

/// Times the number of cells and instants a path can have, whole costs make the flow exact: no cheaper one is left.
TEST(TimeFlow, IsTheCheapestWhenCostsAreCoarserThanEpsilon) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const Reach reach = row_of(5, seed);
    FlowTask task = random_task(reach, 5, 2, 4, true, seed);
    for (std::int32_t& cost : task.stand) cost *= 100;
    for (FlowInterval& interval : task.intervals) {
      for (std::int32_t& cost : interval.cost) cost *= 100;
    }
    const auto flow = solve(task, {1000, 100, 10, 1});
    ASSERT_TRUE(flow);
    EXPECT_EQ(flow->cost, least_of_all(task, 0, 0, 1)) << "seed " << seed;
  }
}

TEST(TimeFlow, KeepsToTheReachAndPutsNobodyOnAnothersCell) {
  EXPECT_TRUE(rc::check([] {
    const auto cells = *rc::gen::inRange<std::uint32_t>(2, 40);
    const auto people = *rc::gen::inRange<std::size_t>(1, cells + 1);
    const auto intervals = *rc::gen::inRange<std::size_t>(1, 12);
    const bool placed = *rc::gen::arbitrary<bool>();
    const Reach reach = row_of(cells, *rc::gen::arbitrary<std::uint64_t>());
    const FlowTask task = random_task(reach, cells, people, intervals, placed, *rc::gen::arbitrary<std::uint64_t>());
    const auto flow = solve(task, {50, 10, 1});
    RC_ASSERT(flow.has_value());
    RC_ASSERT(flow->bound <= flow->cost);
    RC_ASSERT(flow->cost - flow->bound <= widest_gap(people, intervals));
    RC_ASSERT(flow->at.size() == intervals + 1);
    for (std::size_t k = 0; k < flow->at.size(); ++k) {
      RC_ASSERT(std::set<CellIndex>(flow->at[k].begin(), flow->at[k].end()).size() == people);
      for (std::size_t i = 0; k > 0 && i < people; ++i) {
        const auto from = static_cast<int>(flow->at[k - 1][i].value());
        RC_ASSERT(std::abs(from - static_cast<int>(flow->at[k][i].value())) <= 1);
      }
    }
  }));
}

/// Far more bids than nodes, so that all labels are raised and lowered at once many times.
TEST(TimeFlow, IsWithinEpsilonOfItsBoundWhereManyWantTheSamePlaces) {
  for (const bool placed : {true, false}) {
    const Reach reach = row_of(60, 7);
    FlowTask task = random_task(reach, 60, 40, 30, placed, 7);
    for (std::size_t v = 0; v < task.stand.size(); ++v) task.stand[v] -= v % 60 < 30 ? 4000 : 0;
    const auto rough = solve(task, {5000});
    const auto fine = solve(task, {5000, 500, 50, 5});
    ASSERT_TRUE(rough && fine);
    EXPECT_LT(fine->cost, rough->cost);
    EXPECT_LE(fine->cost - fine->bound, std::int64_t{5} * 40 * 61);
  }
}

TEST(TimeFlow, IsAsGoodFromWhateverPricesItStarts) {
  EXPECT_TRUE(rc::check([] {
    const auto cells = *rc::gen::inRange<std::uint32_t>(2, 30);
    const auto people = *rc::gen::inRange<std::size_t>(1, cells + 1);
    const bool placed = *rc::gen::arbitrary<bool>();
    Reach reach = row_of(cells, *rc::gen::arbitrary<std::uint64_t>());
    reach.first.push_back(reach.first.back());  // a cell that nobody can stand on
    const FlowTask task = random_task(reach, cells + 1, people, 8, placed, *rc::gen::arbitrary<std::uint64_t>());
    const auto prices = *rc::gen::container<std::vector<std::int32_t>>(
        task.stand.size(), rc::gen::inRange<std::int32_t>(0, *rc::gen::element(2, 60, 2000)));
    TimeFlowSolver solver(task);
    solver.start_from(prices);
    RC_ASSERT(solver.refine(1, {}));
    const TimeFlow flow = solver.result();
    RC_ASSERT(flow.bound <= flow.cost);
    RC_ASSERT(flow.cost - flow.bound <= widest_gap(people, 8));
    for (const auto& here : flow.at) RC_ASSERT(std::set<CellIndex>(here.begin(), here.end()).size() == people);
    const std::vector<std::int32_t> found = solver.prices();
    RC_ASSERT(std::all_of(found.begin(), found.end(), [](std::int32_t price) { return price >= 0; }));
  }));
}

TEST(TimeFlow, IsNothingWhenStopped) {
  const Reach reach = row_of(5, 1);
  const std::atomic<bool> stop{true};
  const FlowTask task = random_task(reach, 5, 2, 4, true, 1);
  EXPECT_FALSE(TimeFlowSolver(task).refine(1, {{}, &stop}));
}

}  // namespace
}  // namespace footlight::planner
