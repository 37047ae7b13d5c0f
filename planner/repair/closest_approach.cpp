// SPDX-License-Identifier: Apache-2.0
#include "planner/repair/closest_approach.hpp"

#include <algorithm>
#include <limits>

#include "planner/repair/walk_tree.hpp"

namespace footlight::planner {

Approach closest_approach(const Walk& a, const Walk& b, double first, double last) {
  const Point start = a.from - b.from;
  const Point change = (a.to - b.to) - start;
  const double square = squared_length(change);
  const double share = square > 0 ? std::clamp(-dot(start, change) / square, first, last) : first;
  return {length(start + share * change), share};
}

std::vector<NearPair> near_pairs(std::span<const Walk> walks, double reach_m, std::span<const char> among) {
  std::vector<NearPair> found;
  WalkTree tree;
  tree.build(walks);
  tree.find(reach_m, among, WalkTree::Pairs::all, found);
  return found;
}

NearPair nearest_pair(std::span<const Walk> walks) {
  if (walks.size() < 2) return {0, 0, {std::numeric_limits<double>::infinity(), 0}};
  WalkTree tree;
  tree.build(walks);
  return tree.nearest();
}

}  // namespace footlight::planner
