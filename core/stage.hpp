// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/grid.hpp"
#include "core/time.hpp"

namespace footlight {

/// The floor and the limits that hold on it.
struct Stage {
  Grid grid;
  std::vector<CellIndex> blocked;  ///< ascending; nobody stands or walks here
  std::vector<CellIndex> reserve;  ///< ascending; who is not in the picture stands here, dark; disjoint from blocked
  double clearance_m = 0.5;        ///< never nearer than this, centre to centre
  double max_speed_mps = 1.4;
  Duration lag = milliseconds(200);  ///< how late anybody may start or stop without coming too close; reported

  friend bool operator==(const Stage&, const Stage&) = default;
};

}  // namespace footlight
