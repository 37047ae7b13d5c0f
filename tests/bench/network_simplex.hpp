// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "planner/assignment/assignment.hpp"
#include "tests/bench/instances.hpp"

namespace footlight::bench {

/// The cheapest assignment's cost by LEMON's NetworkSimplex over all pairs, an independent peer. Distances are rounded
/// to 2^-30 m. O(N^2) memory: 190 bytes a pair. Throws std::runtime_error when it finds none.
[[nodiscard]] double network_simplex_cost(const Instance& instance, planner::WalkCost cost);

/// The same over listed pairs, costs rounded to 2^-30.
[[nodiscard]] double network_simplex_cost(int people, std::span<const planner::Arc> arcs);

}  // namespace footlight::bench
