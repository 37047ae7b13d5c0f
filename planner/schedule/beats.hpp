// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/grid.hpp"
#include "core/tempo_map.hpp"

namespace footlight::planner {

/// The whole counts on which people step from cell to cell.
struct Beats {
  std::vector<Instant> at;  ///< beginnings of the steps and the end of the last one; one more than steps, or empty
  int counts = 1;           ///< that a step takes
  double step_s = 0;        ///< time of the shortest step

  [[nodiscard]] int steps() const { return at.empty() ? 0 : static_cast<int>(at.size()) - 1; }
};

/// How far in a straight line somebody comes at least with a step over cells, in pitches: along a diagonal; between two
/// of six directions; across the rows of triangles.
[[nodiscard]] double straight_per_step(GridKind kind);

/// Steps of one count each that lie wholly between two instants; of several counts where one is shorter than
/// `least_s`, the shortest time that a step may take at any tempo in between. O(steps log changes)
[[nodiscard]] Beats beats_between(const TempoMap& tempo, Instant from, Instant to, double least_s);

}  // namespace footlight::planner
