// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/stage.hpp"
#include "planner/formation/placement.hpp"

namespace footlight::planner {

/// All places of a disc that moves straight.
struct SweptDisc {
  Point from;
  Point to;
  double radius_m = 0;
};

/// Where people can stand and walk: blocked cells, as their outlines on the floor, are kept at a distance all the way:
/// half of the clearance, or the widest body's radius where that is more.
class Ways {
 public:
  /// @param keep_m how far from a blocked cell's outline everybody stays
  Ways(const Stage& stage, double keep_m);

  [[nodiscard]] const Grid& grid() const { return grid_; }
  [[nodiscard]] double keep_m() const { return keep_m_; }
  [[nodiscard]] double cell_radius_m() const { return cell_radius_m_; }  ///< from a cell's centre to its corners
  /// To the cells around a cell, those at its corners included.
  [[nodiscard]] double around_cell_m() const {
    return (grid_.kind() == GridKind::square ? 1.5 : 1.8) * grid_.pitch_m();
  }
  /// The same floor while discs move over it: walks keep off them, `keep_m` from their edges, wherever they are
  /// `during` the walk, and nobody stands where they are then or `after`.
  [[nodiscard]] Ways beside(const std::vector<SweptDisc>& during, const std::vector<SweptDisc>& after) const;
  /// Nothing is in anybody's way.
  [[nodiscard]] bool open() const { return blocked_cells_.empty() && during_.empty(); }
  [[nodiscard]] const std::vector<CellIndex>& blocked() const { return blocked_cells_; }  ///< ascending
  /// Cells on which somebody may stand, one flag a cell.
  [[nodiscard]] const CellFlags& standable() const { return standable_; }
  [[nodiscard]] bool can_stand(CellIndex cell) const { return standable_[cell.at()] != 0; }
  /// Whether the straight walk keeps off every blocked cell and disc. O(length)
  [[nodiscard]] bool straight(Point from, Point to) const;
  /// Length of the shortest way that was found and the point `walked_m` along it: straight where that is free, else
  /// over neighbouring cells and drawn taut. Nothing reachable: stays at `from`, infinite length.
  struct Step {
    Point at;
    double length_m = 0;
  };
  [[nodiscard]] Step toward(Point from, Point to, double walked_m) const;
  /// The corners of that way, `from` and `to` included; empty when there is none.
  [[nodiscard]] std::vector<Point> way(Point from, Point to) const;
  /// A way without the corners that are not needed: from each of them straight to the last one that can be seen.
  [[nodiscard]] std::vector<Point> taut(std::vector<Point> way) const;

 private:
  [[nodiscard]] std::vector<Point> around(Point from, Point to) const;
  [[nodiscard]] double outline_distance(Point from, Point to, CellIndex blocked) const;

  Grid grid_;
  double keep_m_ = 0;
  double cell_radius_m_ = 0;
  std::vector<CellIndex> blocked_cells_;
  CellFlags blocked_;
  CellFlags standable_;
  std::vector<SweptDisc> during_;
};

}  // namespace footlight::planner
