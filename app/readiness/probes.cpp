// SPDX-License-Identifier: Apache-2.0
#include "app/readiness/probes.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace footlight::app {

std::vector<std::size_t> probe_lamps(const std::vector<FloorLamp>& lamps, const Grid& grid) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  double left = kInfinite;
  double right = -kInfinite;
  double down = kInfinite;
  double up = -kInfinite;
  for (const FloorLamp& lamp : lamps) {
    if (!lamp.cell) continue;
    const Point at = grid.centre(*lamp.cell);
    left = std::min(left, at.x);
    right = std::max(right, at.x);
    down = std::min(down, at.y);
    up = std::max(up, at.y);
  }
  std::vector<std::size_t> chosen;
  for (const auto& [x, y] : std::array{std::pair{left, down}, std::pair{right, down}, std::pair{right, up}}) {
    double nearest = kInfinite;
    std::size_t best = lamps.size();
    for (std::size_t i = 0; i < lamps.size(); ++i) {
      if (!lamps[i].cell || std::ranges::find(chosen, i) != chosen.end()) continue;
      const Point at = grid.centre(*lamps[i].cell);
      const double distance = (at.x - x) * (at.x - x) + (at.y - y) * (at.y - y);
      if (distance >= nearest) continue;
      nearest = distance;
      best = i;
    }
    if (best < lamps.size()) chosen.push_back(best);
  }
  return chosen;
}

ProbeAnswer probe_answer(std::string_view line) {
  if (line == "y" || line == "yes") return ProbeAnswer::yes;
  if (line == "n" || line == "no") return ProbeAnswer::no;
  return line == "skip" ? ProbeAnswer::skip : ProbeAnswer::unclear;
}

}  // namespace footlight::app
