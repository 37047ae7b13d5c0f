// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/grid.hpp"

namespace footlight::planner {

/// Whether a walk may be walked at all: short enough for its time, and clear of blocked cells.
using MayWalk = std::function<bool(Point from, Point to)>;

struct Exchanged {
  int exchanges = 0;
  double squares_saved_m2 = 0;  ///< by how much the sum of squared distances fell
};

/// Exchanges the targets of two people whose walks conflict (Li 2020 section III D, figure 6): who come nearer than
/// `reach_m` with (s_i - s_j) . (g_i - g_j) < 0. Each exchange lowers the sum of the squared distances by
/// -2 (s_i - s_j) . (g_i - g_j), so it ends; a pair with a product >= 0 keeps the grid's bound by itself (Turpin,
/// Michael, Kumar 2014). An exchange that would make a walk that may not be walked is not made, nor one between people
/// of two kinds.
/// @param target_of in and out: a bijection  @param kind of each source's person; empty: everybody is of one kind
/// @return what was done. O(rounds x near pairs)
Exchanged exchange(std::span<const Point> sources, std::span<const Point> targets,
                   std::vector<std::uint32_t>& target_of, double reach_m, const MayWalk& may_walk,
                   std::span<const std::uint32_t> kind = {});

}  // namespace footlight::planner
