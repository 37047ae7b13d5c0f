// SPDX-License-Identifier: Apache-2.0
#include "planner/assignment/phases.hpp"

#include <array>
#include <atomic>
#include <initializer_list>

#include <gtest/gtest.h>

namespace footlight::planner::assignment {
namespace {

struct Row {
  std::uint32_t target;
  Value cost;
};

ArcRows rows_of(std::initializer_list<std::initializer_list<Row>> sources) {
  ArcRows rows;
  for (const auto& source : sources) {
    for (const Row& arc : source) rows.add(arc.target, arc.cost);
    rows.close_row();
  }
  return rows;
}

Matching with_targets(std::initializer_list<std::uint32_t> target_of) {
  Matching matching;
  matching.target_of = target_of;
  matching.price.assign(target_of.size(), 0);
  return matching;
}

/// Who is free at first reaches one free target by 3000 in short arcs, and another by 2490, most of it in one arc that
/// is longer than the window of the buckets.
TEST(Phases, WhatIsTooFarForTheBucketsIsNotPassedOver) {
  const auto same = [] {
    return rows_of({{{1, 2500}, {2, 10}},
                    {{1, 0}, {5, 0}},
                    {{2, 0}, {3, 1500}},
                    {{3, 0}, {4, 1500}},
                    {{0, 1000}, {4, 0}},
                    {{6, 0}},
                    {{0, 4500}, {5, 9000}, {6, 0}}});
  };
  for (const bool small_costs : {true, false}) {
    ArcRows rows = same();
    Matching matching = with_targets({kNobody, 1, 2, 3, 4, kNobody, 6});
    Phases phases(rows, matching, small_costs);
    phases.tighten();
    EXPECT_EQ(phases.run({}), Phases::Outcome::perfect);
    EXPECT_EQ(matching.target_of, (std::vector<std::uint32_t>{1, 5, 2, 3, 4, 6, 0})) << small_costs;
  }
}

TEST(Phases, GiveUpWhenTheyHaveLookedAtTooManyArcsOrAreStopped) {
  const std::atomic<bool> stopped = true;
  for (const Patience& patience : {Patience{0, nullptr}, Patience{1000, &stopped}}) {
    // Both want target 0: one of them, and only she, can go elsewhere.
    ArcRows rows = rows_of({{{0, 1}}, {{0, 1}, {1, 5}}});
    Matching matching = with_targets({kNobody, 0});
    Phases phases(rows, matching, true);
    phases.tighten();
    EXPECT_EQ(phases.run({1, nullptr}), Phases::Outcome::perfect);
    EXPECT_GT(phases.looked_at(), 0U);
    phases.add(std::array{ArcRows::NewArc{0, 1, 0}});
    EXPECT_EQ(phases.run(patience), Phases::Outcome::given_up);
  }
}

}  // namespace
}  // namespace footlight::planner::assignment
