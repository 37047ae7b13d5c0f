// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "planner/motion/floor.hpp"

namespace footlight::planner::srd {

/// What people ask of a floor with blocked cells, worked out once for all steps: how much is free around, the nearest
/// free place, whether something stands between, and the first corner of the way around it.
class FreeFloor {
 public:
  /// O(cells x blocked cells near), nothing on an open floor
  explicit FreeFloor(const MotionFloor& floor);

  [[nodiscard]] const MotionFloor& floor() const { return *floor_; }
  [[nodiscard]] bool open() const { return floor_->ways().open(); }
  /// Everybody at `at` may go so far in any direction, at least; 0: not known. O(1)
  [[nodiscard]] double free_m(Point at) const;
  /// `at`, or the centre of the nearest cell on which somebody can stand, where nobody can stand at `at`.
  [[nodiscard]] Point free_place(Point at) const;
  /// Whether the straight way is free.
  [[nodiscard]] bool sees(Point from, Point to) const;
  /// Where to go first from `from` to come to `to`: `to` itself when it is seen, `from` when there is no way.
  [[nodiscard]] Point first_corner(Point from, Point to) const;
  /// Out of what is too near, by the shortest way where that is known.
  [[nodiscard]] Point pushed_out(Point at) const;
  /// Whether people can walk from one place to the other at all.
  [[nodiscard]] bool connected(Point from, Point to) const;

 private:
  void measure();
  void find_places();

  const MotionFloor* floor_;
  std::vector<float> free_m_;        ///< around each cell's centre, at most kFarthest_m
  std::vector<CellIndex> place_;     ///< nearest cell to stand on
  std::vector<std::uint32_t> part_;  ///< cells with equal numbers are connected
};

}  // namespace footlight::planner::srd
