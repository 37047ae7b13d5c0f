// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/grid.hpp"

namespace footlight::planner::assignment {

/// An order of points in which each aligned run of 16, 256, 4096, ... points is one box of a k-d tree (Bentley 1975),
/// so that a tree with 16 children a node needs no pointers, and so is each aligned run of four.
/// Deterministic for distinct points. O(N log N)
[[nodiscard]] std::vector<std::uint32_t> kd_order(std::span<const Point> points);

}  // namespace footlight::planner::assignment
