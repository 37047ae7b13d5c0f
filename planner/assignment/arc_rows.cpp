// SPDX-License-Identifier: Apache-2.0
#include "planner/assignment/arc_rows.hpp"

#include <cstddef>

namespace footlight::planner::assignment {

void ArcRows::merge(std::span<const NewArc> arcs) {
  ArcRows merged;
  merged.first.reserve(first.size());
  merged.target.reserve(target.size() + arcs.size());
  merged.cost.reserve(cost.size() + arcs.size());
  std::size_t next = 0;
  for (std::uint32_t i = 0; i < size(); ++i) {
    for (std::uint32_t e = first[i]; e < first[i + 1]; ++e) merged.add(target[e], cost[e]);
    for (; next < arcs.size() && arcs[next].source == i; ++next) merged.add(arcs[next].target, arcs[next].cost);
    merged.close_row();
  }
  *this = std::move(merged);
}

}  // namespace footlight::planner::assignment
