// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "planner/judge/geometry.hpp"

namespace footlight::planner::judge {

/// Finds the overlapping pairs among many boxes with a uniform grid. Keeps its memory from call to call.
class NearPairs {
 public:
  using Pair = std::pair<std::uint32_t, std::uint32_t>;

  /// @return every pair (i, j), i < j, of overlapping boxes, once; empty boxes overlap nothing. Valid until the next
  /// call. Complexity: O(boxes + overlapping pairs) for boxes of like size. Deterministic.
  std::span<const Pair> find(std::span<const Box> boxes);

 private:
  struct Range {
    int x0, y0, x1, y1;  ///< tiles, both ends included; x1 < x0: the box is empty
  };
  void lay_tiles(std::span<const Box> boxes);
  void fill_tiles();

  double left_m_ = 0;
  double bottom_m_ = 0;
  double tiles_per_m_ = 1;
  int columns_ = 1;
  int rows_ = 1;
  std::vector<Range> ranges_;
  std::vector<std::uint32_t> first_;    // of each tile in members_, one more at the end
  std::vector<std::uint32_t> members_;  // boxes, tile by tile
  std::vector<Pair> pairs_;
};

}  // namespace footlight::planner::judge
