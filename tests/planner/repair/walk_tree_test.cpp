// SPDX-License-Identifier: Apache-2.0
#include "planner/repair/walk_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"

namespace footlight::planner {
namespace {

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// People on whole metres of a small floor: many equal places, many who stand still or walk alike, many ties.
std::vector<Walk> crowd_on_cells(Rng& rng, std::uint64_t people, std::uint64_t side) {
  const auto cell = [&] { return Point{double(rng.below(side)), double(rng.below(side))}; };
  std::vector<Walk> walks;
  for (std::uint64_t i = 0; i < people; ++i) {
    const Point from = cell();
    const std::uint64_t way = rng.below(3);
    walks.push_back({from, way == 0 ? from : way == 1 ? from + Point{7, 3} : cell()});
  }
  return walks;
}

Pairs near_by_looking_at_all(const std::vector<Walk>& walks, double reach_m, const std::vector<char>& among,
                             WalkTree::Pairs which) {
  Pairs out;
  for (std::uint32_t a = 0; a < walks.size(); ++a) {
    for (std::uint32_t b = a + 1; b < walks.size(); ++b) {
      if (!among.empty() && among[a] == 0 && among[b] == 0) continue;
      const double product = dot(walks[a].from - walks[b].from, walks[a].to - walks[b].to);
      if (which == WalkTree::Pairs::opposed && product >= 0) continue;
      if (closest_approach(walks[a], walks[b]).distance_m < reach_m) out.emplace_back(a, b);
    }
  }
  return out;
}

Pairs names(const std::vector<NearPair>& found) {
  Pairs out;
  for (const NearPair& pair : found) out.emplace_back(pair.a, pair.b);
  return out;
}

TEST(WalkTree, FindsExactlyThePairsThatLookingAtAllFinds) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    const auto walks = crowd_on_cells(rng, 1 + rng.below(300), 4 + rng.below(40));
    std::vector<char> among;
    if (rng.below(2) == 0) {
      for (std::size_t i = 0; i < walks.size(); ++i) among.push_back(rng.below(5) == 0 ? 1 : 0);
    }
    const double reach_m = 0.1 + 2 * rng.uniform();
    WalkTree tree;
    tree.build(walks);
    std::vector<NearPair> found;
    for (const auto which : {WalkTree::Pairs::all, WalkTree::Pairs::opposed}) {
      tree.find(reach_m, among, which, found);
      RC_ASSERT(names(found) == near_by_looking_at_all(walks, reach_m, among, which));
    }
  }));
}

TEST(WalkTree, FollowsPeopleWhoWalkElsewhere) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    auto walks = crowd_on_cells(rng, 2 + rng.below(200), 20);
    WalkTree tree;
    tree.build(walks);
    for (int round = 0; round < 3; ++round) {
      for (int change = 0; change < 20; ++change) {
        const auto count = static_cast<std::uint32_t>(walks.size());
        std::swap(walks[rng.below(count)].to, walks[rng.below(count)].to);
      }
      tree.move(walks);
      std::vector<NearPair> found;
      tree.find(0.7, {}, WalkTree::Pairs::all, found);
      RC_ASSERT(names(found) == near_by_looking_at_all(walks, 0.7, {}, WalkTree::Pairs::all));
    }
  }));
}

TEST(WalkTree, NamesTheFirstOfTheNearestPairs) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint32_t>());
    const auto walks = crowd_on_cells(rng, 2 + rng.below(200), 10 + rng.below(200));
    NearPair expected{0, 0, {std::numeric_limits<double>::infinity(), 0}};
    for (std::uint32_t a = 0; a < walks.size(); ++a) {
      for (std::uint32_t b = a + 1; b < walks.size(); ++b) {
        const Approach approach = closest_approach(walks[a], walks[b]);
        if (approach.distance_m < expected.approach.distance_m) expected = {a, b, approach};
      }
    }
    WalkTree tree;
    tree.build(walks);
    const NearPair nearest = tree.nearest();
    RC_ASSERT(nearest.approach.distance_m == expected.approach.distance_m);
    RC_ASSERT(std::pair(nearest.a, nearest.b) == std::pair(expected.a, expected.b));
  }));
}

}  // namespace
}  // namespace footlight::planner
