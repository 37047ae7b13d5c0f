// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/stage.hpp"
#include "planner/formation/placement.hpp"

namespace footlight::planner {

/// Where people can stand and walk: blocked cells, as their outlines on the floor, are kept at a distance all the way:
/// half of the clearance, or the widest body's radius where that is more.
class Ways {
 public:
  /// @param keep_m how far from a blocked cell's outline everybody stays
  Ways(const Stage& stage, double keep_m);

  [[nodiscard]] const Grid& grid() const { return grid_; }
  [[nodiscard]] double keep_m() const { return keep_m_; }
  /// Nothing stands in anybody's way on this stage.
  [[nodiscard]] bool open() const { return blocked_cells_.empty(); }
  [[nodiscard]] const std::vector<CellIndex>& blocked() const { return blocked_cells_; }  ///< ascending
  /// Cells on which somebody may stand, one flag a cell.
  [[nodiscard]] const CellFlags& standable() const { return standable_; }
  [[nodiscard]] bool can_stand(CellIndex cell) const { return standable_[cell.at()] != 0; }
  /// Whether the straight walk keeps off every blocked cell. O(length)
  [[nodiscard]] bool straight(Point from, Point to) const;
  /// Length of the shortest way that was found and the point `walked_m` along it: straight where that is free, else
  /// over neighbouring cells and drawn taut. Nothing reachable: stays at `from`, infinite length.
  struct Step {
    Point at;
    double length_m = 0;
  };
  [[nodiscard]] Step toward(Point from, Point to, double walked_m) const;

 private:
  [[nodiscard]] std::vector<Point> around(Point from, Point to) const;
  [[nodiscard]] double outline_distance(Point from, Point to, CellIndex blocked) const;

  Grid grid_;
  double keep_m_ = 0;
  double cell_radius_m_ = 0;
  std::vector<CellIndex> blocked_cells_;
  CellFlags blocked_;
  CellFlags standable_;
};

}  // namespace footlight::planner
