// SPDX-License-Identifier: Apache-2.0
#include "planner/repair/exchange.hpp"

#include <algorithm>

#include "core/check.hpp"
#include "planner/repair/walk_tree.hpp"

namespace footlight::planner {

Exchanged exchange(std::span<const Point> sources, std::span<const Point> targets,
                   std::vector<std::uint32_t>& target_of, double reach_m, const MayWalk& may_walk,
                   std::span<const std::uint32_t> kind) {
  FL_CHECK(kind.empty() || kind.size() == sources.size());
  Exchanged done;
  std::vector<Walk> walks(sources.size());
  for (std::size_t i = 0; i < sources.size(); ++i) walks[i] = {sources[i], targets[target_of[i]]};
  // Only who walks elsewhere than in the round before can have new conflicts.
  std::vector<char> changed(sources.size(), 1);
  std::vector<NearPair> pairs;
  WalkTree tree;
  tree.build(walks);
  for (;;) {
    int exchanged = 0;
    tree.find(reach_m, changed, WalkTree::Pairs::opposed, pairs);
    std::fill(changed.begin(), changed.end(), char{0});
    for (const NearPair& pair : pairs) {
      if (!kind.empty() && kind[pair.a] != kind[pair.b]) continue;
      Walk& a = walks[pair.a];
      Walk& b = walks[pair.b];
      const double product = dot(a.from - b.from, a.to - b.to);
      if (product >= 0 || closest_approach(a, b).distance_m >= reach_m) continue;
      if (!may_walk(a.from, b.to) || !may_walk(b.from, a.to)) continue;
      std::swap(a.to, b.to);
      std::swap(target_of[pair.a], target_of[pair.b]);
      changed[pair.a] = changed[pair.b] = 1;
      done.squares_saved_m2 += -2 * product;
      ++exchanged;
    }
    done.exchanges += exchanged;
    if (exchanged == 0) return done;
    tree.move(walks);
  }
}

}  // namespace footlight::planner
