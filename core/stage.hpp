// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "core/grid.hpp"
#include "core/time.hpp"

namespace footlight {

/// How people walk from one formation to the next.
enum class WalkKind {
  straight,  ///< in a straight line at constant speed
  cells,     ///< over neighbouring cells, one a count, on whole counts
};

[[nodiscard]] constexpr std::string_view to_text(WalkKind kind) {
  return kind == WalkKind::cells ? "cells" : "straight";
}
[[nodiscard]] constexpr std::optional<WalkKind> walk_kind_from(std::string_view text) {
  if (text == "straight") return WalkKind::straight;
  if (text == "cells") return WalkKind::cells;
  return std::nullopt;
}

/// The floor and the limits that hold on it.
struct Stage {
  Grid grid;
  std::vector<CellIndex> blocked;  ///< ascending; nobody stands or walks here
  std::vector<CellIndex> reserve;  ///< ascending; who is not in the picture stands here, dark; disjoint from blocked
  double clearance_m = 0.5;        ///< never nearer than this, centre to centre
  double max_speed_mps = 1.4;
  Duration lag = milliseconds(200);  ///< how late anybody may start or stop without coming too close; reported
  WalkKind walk = WalkKind::straight;

  friend bool operator==(const Stage&, const Stage&) = default;
};

}  // namespace footlight
