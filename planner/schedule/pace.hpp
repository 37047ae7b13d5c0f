// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "planner/schedule/ways.hpp"

namespace footlight::planner {

/// Where somebody should be at an instant.
struct Wanted {
  Point at;
  bool own = true;  ///< the middle of the own cell; else a point on the way
};

/// One instant of the ideal tracks: a slot is a place in the formations that one person at a time fills; slot i of one
/// instant leads to slot i of the next.
struct PaceInstant {
  std::vector<CellIndex> own;  ///< cell of each slot; distinct
  bool exact = false;          ///< images, cells, first formations: nobody may be elsewhere
  double longest_m = 0;        ///< how far anybody can walk from here to the next instant
};

/// Who waits in the reserve leaves early enough to be in the picture on time: reserve time is free, running is not.
/// Goes backwards from each place in the picture along the way to the reserve cell, `longest_m` less a margin for the
/// snap to cells at a time, until the reserve cell (or the first instant of the stretch) is reached.
/// @param reserve one flag a cell  @return for each instant and slot. O(instants x slots)
[[nodiscard]] std::vector<std::vector<Wanted>> leave_early(const Ways& ways, const std::vector<PaceInstant>& instants,
                                                           const CellFlags& reserve);

/// How far somebody goes in an interval who will be put on the nearest free cell.
[[nodiscard]] double paced_m(double longest_m, double pitch_m);

}  // namespace footlight::planner
