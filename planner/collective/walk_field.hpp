// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "planner/motion/cell_steps.hpp"

namespace footlight::planner::collective {

/// Lengths of walkable ways over the cells of a floor, around what is blocked.
///
/// Steps go from a cell to all cells within 2.3 pitches whose straight way is free: 16 directions on squares, 12 on
/// hexagons and triangles. A shortest way over such steps is longer than the true one by a factor of at most
/// `longest()`: 1 / cos(half of the widest angle between two directions), 1.0275 on squares, 1.0353 on the others; and
/// by less than a pitch for each corner that it goes around, since it bends in the middle of a cell.
class WalkField {
 public:
  explicit WalkField(const Ways& ways);

  /// Steps from every cell to `goal`, m, infinity where there is no way. O(cells log cells)
  [[nodiscard]] std::vector<float> to(CellIndex goal) const { return steps_.lengths_to(goal); }
  [[nodiscard]] CellIndex cell_at(Point point) const { return steps_.ways().grid().nearest(point); }
  /// How many times the true length a length of `to` may be.
  [[nodiscard]] double longest() const { return longest_; }
  /// Of the true length: between it and it divided by longest().  @param steps_m out of `to`
  [[nodiscard]] double length_m(double steps_m, double straight_m) const;

  /// Corners of a way, drawn taut: from, ..., to. Empty: there is none. O(cells log cells)
  [[nodiscard]] std::vector<Point> way(Point from, Point to) const;

 private:
  CellSteps steps_;
  double longest_ = 1;
};

}  // namespace footlight::planner::collective
