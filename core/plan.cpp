// SPDX-License-Identifier: Apache-2.0
#include "core/plan.hpp"

#include <algorithm>

#include "core/check.hpp"

namespace footlight {

Point position_at(const Grid& grid, const std::vector<Mark>& track, Instant instant) {
  FL_CHECK(!track.empty());
  const auto after =
      std::upper_bound(track.begin(), track.end(), instant, [](Instant t, const Mark& mark) { return t < mark.time; });
  if (after == track.begin()) return grid.centre(track.front().cell);
  const Mark& from = *std::prev(after);
  if (after == track.end()) return grid.centre(from.cell);
  const double share = to_seconds(instant - from.time) / to_seconds(after->time - from.time);
  const Point a = grid.centre(from.cell);
  return a + share * (grid.centre(after->cell) - a);
}

}  // namespace footlight
