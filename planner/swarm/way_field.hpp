// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "planner/motion/cell_steps.hpp"

namespace footlight::planner::swarm {

/// Which cells can be walked to from which, on a floor on which something is blocked, and which parts it has.
class Passages {
 public:
  explicit Passages(const Ways& ways) : steps_(ways, ways.around_cell_m()), part_(steps_.parts()) {}

  [[nodiscard]] const Ways& ways() const { return steps_.ways(); }
  [[nodiscard]] const CellSteps& steps() const { return steps_; }
  /// Part of the floor that a point is in: two points with one number can reach each other. By the nearest cell.
  [[nodiscard]] std::uint32_t part(Point at) const { return part_[ways().grid().nearest(at).at()]; }
  /// The nearest cell to a point among those of one part; the first of equals. O(cells)
  [[nodiscard]] CellIndex nearest_in(std::uint32_t part, Point at) const;

 private:
  CellSteps steps_;
  std::vector<std::uint32_t> part_;
};

/// The shortest way from everywhere to one cell, over neighbouring cells. One field serves a whole crowd.
class WayField {
 public:
  /// O(cells log cells)
  WayField(const Passages& passages, CellIndex goal);

  /// Where to go straight from `at` so as to come to the goal, and how long the way is from there.
  struct Toward {
    Point at;
    double rest_m = 0;
  };
  /// As far along the way as can be seen, but no more than some cells. Where there is no way: stays.
  [[nodiscard]] Toward toward(Point at) const;

 private:
  /// The best cell on the way for who stands where no cell can be stood on, just beside something blocked.
  [[nodiscard]] std::uint32_t enter(Point at) const;

  const Passages* passages_;
  std::vector<std::uint32_t> next_;  ///< of each cell, on the way
  std::vector<float> rest_m_;
};

}  // namespace footlight::planner::swarm
