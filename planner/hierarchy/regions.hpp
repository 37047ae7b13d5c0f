// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/grid.hpp"

namespace footlight::planner {

/// Limits of a region's growth, Li 2020 Eq. 7.
struct RegionLimits {
  int most_people = 60;     ///< T_n, >= 1
  double variance_m2 = 30;  ///< T_v: mean squared distance from the region's anchor, m^2
};

/// A set of people who stand together, as positions in the list that was divided.
struct Region {
  std::vector<std::uint32_t> members;  ///< in the order of growth
  Point anchor;                        ///< mean of the members' places, m
};

/// Divides people into regions by constrained growing (Li 2020 section III D): a seed on the boundary of what is left
/// (the person with the fewest neighbours left, the first in cell order among equals), then one after another the
/// neighbour nearest to the anchor, until the next one would break a limit or nobody is adjacent.
/// @param cells distinct  @return every position in exactly one region. O(n log n) for regions of bounded size
[[nodiscard]] std::vector<Region> grow_regions(const Grid& grid, std::span<const CellIndex> cells,
                                               const RegionLimits& limits);

}  // namespace footlight::planner
