// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/network_simplex.hpp"

#include <cmath>
#include <cstdint>
#include <stdexcept>

#include <lemon/network_simplex.h>
#include <lemon/smart_graph.h>

namespace footlight::bench {

double network_simplex_cost(const Instance& instance, planner::WalkCost cost) {
  const int people = static_cast<int>(instance.sources.size());
  const double scale = cost == planner::WalkCost::squared ? 1 : 0x1p30;
  lemon::SmartDigraph graph;
  graph.reserveNode(2 * people);
  graph.reserveArc(people * people);
  for (int k = 0; k < 2 * people; ++k) graph.addNode();
  lemon::SmartDigraph::ArcMap<std::int64_t> costs(graph);
  lemon::SmartDigraph::NodeMap<std::int64_t> supply(graph, 1);
  for (int j = 0; j < people; ++j) supply[lemon::SmartDigraph::nodeFromId(people + j)] = -1;
  for (int i = 0; i < people; ++i) {
    for (int j = 0; j < people; ++j) {
      const Point walk = instance.sources[i] - instance.targets[j];
      const double value = cost == planner::WalkCost::squared ? squared_length(walk) : length(walk);
      const auto arc = graph.addArc(lemon::SmartDigraph::nodeFromId(i), lemon::SmartDigraph::nodeFromId(people + j));
      costs[arc] = std::llround(value * scale);
    }
  }
  lemon::NetworkSimplex<lemon::SmartDigraph, std::int64_t> simplex(graph);
  simplex.costMap(costs).supplyMap(supply);
  if (simplex.run() != decltype(simplex)::OPTIMAL) throw std::runtime_error("NetworkSimplex found no assignment");
  return static_cast<double>(simplex.totalCost<std::int64_t>()) / scale;
}

}  // namespace footlight::bench
