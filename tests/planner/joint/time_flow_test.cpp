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
Reach row_of(std::uint32_t cells) {
  Reach reach;
  for (std::uint32_t c = 0; c < cells; ++c) {
    reach.first.push_back(static_cast<std::uint32_t>(reach.to.size()));
    for (std::uint32_t to = c == 0 ? 0 : c - 1; to <= std::min(c + 1, cells - 1); ++to) reach.to.push_back(to);
  }
  reach.first.push_back(static_cast<std::uint32_t>(reach.to.size()));
  reach.find_back();
  return reach;
}

FlowTask random_task(const Reach& reach, std::uint32_t cells, std::size_t people, std::size_t intervals,
                     std::uint64_t seed) {
  Rng rng(seed);
  const auto cost = [&] { return static_cast<std::int32_t>(rng.below(41)) - 20; };
  FlowTask task;
  task.cells = cells;
  for (std::size_t i = 0; i < people; ++i) task.start.push_back(CellIndex::of(i));
  for (std::size_t k = 0; k < intervals; ++k) {
    FlowInterval interval{&reach, {}};
    for (std::size_t a = 0; a < reach.to.size(); ++a) interval.cost.push_back(cost());
    task.intervals.push_back(std::move(interval));
  }
  for (std::uint32_t c = 0; c < cells; ++c) task.end_cost.push_back(cost());
  return task;
}

/// Every plan of two people, one after the other.
std::int64_t least_of_all(const FlowTask& task, std::size_t k, std::uint32_t a, std::uint32_t b) {
  if (k == task.intervals.size()) return std::int64_t{task.end_cost[a]} + task.end_cost[b];
  const FlowInterval& interval = task.intervals[k];
  const Reach& reach = *interval.reach;
  std::int64_t least = 1'000'000;
  for (std::uint32_t i = reach.first[a]; i < reach.first[a + 1]; ++i) {
    for (std::uint32_t j = reach.first[b]; j < reach.first[b + 1]; ++j) {
      if (reach.to[i] == reach.to[j]) continue;
      least =
          std::min(least, interval.cost[i] + interval.cost[j] + least_of_all(task, k + 1, reach.to[i], reach.to[j]));
    }
  }
  return least;
}

TEST(TimeFlow, CostsNoMoreThanAnyPlanOfTwoPeople) {
  const Reach reach = row_of(5);
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const FlowTask task = random_task(reach, 5, 2, 4, seed);
    const auto flow = cheapest_flow(task, {});
    ASSERT_TRUE(flow);
    EXPECT_EQ(flow->cost, least_of_all(task, 0, 0, 1)) << "seed " << seed;
    EXPECT_EQ(flow->gap, 0) << "seed " << seed;
  }
}

TEST(TimeFlow, ProvesThatItIsCheapestAndPutsNobodyOnAnothersCell) {
  rc::check([] {
    const auto cells = *rc::gen::inRange<std::uint32_t>(2, 40);
    const auto people = *rc::gen::inRange<std::size_t>(1, cells + 1);
    const auto intervals = *rc::gen::inRange<std::size_t>(1, 12);
    const Reach reach = row_of(cells);
    const FlowTask task = random_task(reach, cells, people, intervals, *rc::gen::arbitrary<std::uint64_t>());
    const auto flow = cheapest_flow(task, {});
    RC_ASSERT(flow.has_value());
    RC_ASSERT(flow->gap == 0);
    RC_ASSERT(flow->at.size() == intervals + 1);
    for (std::size_t k = 0; k < flow->at.size(); ++k) {
      RC_ASSERT(std::set<CellIndex>(flow->at[k].begin(), flow->at[k].end()).size() == people);
      for (std::size_t i = 0; k > 0 && i < people; ++i) {
        const auto from = static_cast<int>(flow->at[k - 1][i].value());
        RC_ASSERT(std::abs(from - static_cast<int>(flow->at[k][i].value())) <= 1);
      }
    }
  });
}

TEST(TimeFlow, IsNothingWhenStopped) {
  const Reach reach = row_of(5);
  const std::atomic<bool> stop{true};
  EXPECT_FALSE(cheapest_flow(random_task(reach, 5, 2, 4, 1), {{}, &stop}));
}

}  // namespace
}  // namespace footlight::planner
