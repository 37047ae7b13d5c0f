// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/grid.hpp"
#include "core/show.hpp"

namespace footlight::planner {

/// So many people at (or wanted at) a region's anchor.
struct Load {
  Point anchor;
  int people = 0;
};

/// How many people go from region `from` to region `to`.
struct Shipment {
  std::uint32_t from = 0;
  std::uint32_t to = 0;
  int people = 0;

  friend bool operator==(const Shipment&, const Shipment&) = default;
};

/// What a walk from `a` to `b` costs: its length in m, or the square of it.
[[nodiscard]] double pairing_cost(PairingCost cost, Point a, Point b);

/// The cheapest way to carry people from regions to regions by the cost between the anchors: what takes the place of a
/// matching between anchors where the two sides differ in number and size of regions (Li 2020, Algorithm 1 line 4,
/// leaves that open). Successive shortest paths with potentials.
/// @param from, to  the same sum of people
/// @return ascending by (from, to), people > 0. O((R + S)^2) a path, about as many paths as regions
[[nodiscard]] std::vector<Shipment> transport(std::span<const Load> from, std::span<const Load> to, PairingCost cost);

}  // namespace footlight::planner
