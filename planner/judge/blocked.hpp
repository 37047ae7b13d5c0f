// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/stage.hpp"
#include "planner/judge/geometry.hpp"

namespace footlight::planner::judge {

/// The cells nobody may walk on, found quickly by place.
class BlockedFloor {
 public:
  explicit BlockedFloor(const Stage& stage);

  [[nodiscard]] bool empty() const { return cells_.empty(); }
  [[nodiscard]] bool contains(CellIndex cell) const;

  struct Hit {
    CellIndex cell;
    double distance_m = 0;
  };
  /// Blocked cells whose outline is nearer than `limit_m` to the segment a -> b, ascending. O(tiles of the box)
  [[nodiscard]] std::vector<Hit> nearer_than(Point a, Point b, double limit_m) const;

 private:
  struct Outline {
    CellIndex cell;
    std::vector<Point> corners;
    Box box;
  };
  [[nodiscard]] int column(double x) const;
  [[nodiscard]] int row(double y) const;

  std::vector<Outline> cells_;  // ascending by cell
  Box all_;
  double tile_m_ = 1;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::vector<std::uint32_t>> tiles_;  // cells_ whose box touches the tile
};

}  // namespace footlight::planner::judge
