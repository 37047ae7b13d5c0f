// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/network_simplex.hpp"

#include <cmath>
#include <cstdint>
#include <stdexcept>

#include <lemon/network_simplex.h>
#include <lemon/smart_graph.h>

namespace footlight::bench {

namespace {

constexpr double kFinest = 0x1p30;

double solve(int people, std::span<const planner::Arc> arcs, double scale) {
  lemon::SmartDigraph graph;
  graph.reserveNode(2 * people);
  graph.reserveArc(static_cast<int>(arcs.size()));
  for (int k = 0; k < 2 * people; ++k) graph.addNode();
  lemon::SmartDigraph::ArcMap<std::int64_t> costs(graph);
  lemon::SmartDigraph::NodeMap<std::int64_t> supply(graph, 1);
  for (int j = 0; j < people; ++j) supply[lemon::SmartDigraph::nodeFromId(people + j)] = -1;
  for (const planner::Arc& arc : arcs) {
    const auto added = graph.addArc(lemon::SmartDigraph::nodeFromId(static_cast<int>(arc.source)),
                                    lemon::SmartDigraph::nodeFromId(people + static_cast<int>(arc.target)));
    costs[added] = std::llround(arc.cost * scale);
  }
  lemon::NetworkSimplex<lemon::SmartDigraph, std::int64_t> simplex(graph);
  simplex.costMap(costs).supplyMap(supply);
  if (simplex.run() != decltype(simplex)::OPTIMAL) throw std::runtime_error("NetworkSimplex found no assignment");
  return static_cast<double>(simplex.totalCost<std::int64_t>()) / scale;
}

}  // namespace

double network_simplex_cost(int people, std::span<const planner::Arc> arcs) { return solve(people, arcs, kFinest); }

double network_simplex_cost(const Instance& instance, planner::WalkCost cost) {
  const auto people = static_cast<std::uint32_t>(instance.sources.size());
  std::vector<planner::Arc> arcs;
  arcs.reserve(std::size_t{people} * people);
  for (std::uint32_t i = 0; i < people; ++i) {
    for (std::uint32_t j = 0; j < people; ++j) {
      const Point walk = instance.sources[i] - instance.targets[j];
      arcs.push_back({i, j, cost == planner::WalkCost::squared ? squared_length(walk) : length(walk)});
    }
  }
  return solve(static_cast<int>(people), arcs, cost == planner::WalkCost::squared ? 1 : kFinest);
}

}  // namespace footlight::bench
