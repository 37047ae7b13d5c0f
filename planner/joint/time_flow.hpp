// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/index.hpp"
#include "planner/progress.hpp"

namespace footlight::planner {

/// Which cells can be reached from each cell in one interval: the ones of cell c are to[first[c]] .. to[first[c + 1]].
/// Symmetric, and every cell on which people may stand reaches itself; the others reach nothing.
struct Reach {
  std::vector<std::uint32_t> first;
  std::vector<std::uint32_t> to;
  std::vector<std::uint32_t> back;  ///< for each walk the position of the same walk the other way round

  /// Fills `back`. O(walks log)
  void find_back();
};

/// One interval: the cost of each walk of `reach`, in the same order.
struct FlowInterval {
  const Reach* reach = nullptr;
  std::vector<std::int32_t> cost;
};

/// People walk from fixed cells through intervals and end where they like; no cell is held by two at an instant.
struct FlowTask {
  std::size_t cells = 0;
  std::vector<CellIndex> start;         ///< distinct, one for each person
  std::vector<FlowInterval> intervals;  ///< at least one; |cost| < 2^20, sums over all intervals < 2^30
  std::vector<std::int32_t> end_cost;   ///< of standing on each cell at the last instant
};

struct TimeFlow {
  std::vector<std::vector<CellIndex>> at;  ///< for each instant (intervals + 1) and person
  std::int64_t cost = 0;
  /// cost less the value of the dual solution found with it: 0 proves that no plan of walks costs less.
  std::int64_t gap = 0;
};

/// The cheapest walks of all people through all intervals together: a minimum-cost flow in the network of cells and
/// instants with one person a node, by successive shortest paths (Dijkstra, potentials; Ahuja, Magnanti, Orlin 1993,
/// section 9.7). The first potentials are the exact costs to the end, so that a search goes straight ahead until people
/// compete. @return nothing when stopped. O(people x walks log nodes) at worst. Deterministic. Thread: reentrant.
[[nodiscard]] std::optional<TimeFlow> cheapest_flow(const FlowTask& task, const Progress& progress);

}  // namespace footlight::planner
