// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/diagnostic.hpp"
#include "core/grid.hpp"

namespace footlight {

/// How the ground slows people down: a grey map that is stretched over the whole floor. Black is level ground, white is
/// where people walk with the smallest share of their speed.
struct Terrain {
  std::string path;      ///< as resolved against the show file's folder
  double slowest = 0.5;  ///< share of speed on white, [0.1, 1]
  int width = 0;         ///< pixels; 0: not decoded yet
  int height = 0;
  std::vector<std::uint8_t> grey;  ///< width x height, row 0 is upstage, column 0 stage right
  Position position;

  /// Share of everybody's speed at a point, `slowest`..1: even between the middles of four pixels, at the edge that of
  /// the pixel there. O(1)  @param low, high opposite corners of the floor
  [[nodiscard]] double speed_factor(Point at, Point low, Point high) const {
    const auto place = [](double share, int pixels) { return std::clamp(share * pixels - 0.5, 0.0, pixels - 1.0); };
    const double column = place((at.x - low.x) / (high.x - low.x), width);
    const double row = place((high.y - at.y) / (high.y - low.y), height);
    const auto x = std::min(static_cast<int>(column), std::max(0, width - 2));
    const auto y = std::min(static_cast<int>(row), std::max(0, height - 2));
    const auto pixel = [&](int i, int j) {
      const auto n = static_cast<std::size_t>(std::min(j, height - 1)) * static_cast<std::size_t>(width) +
                     static_cast<std::size_t>(std::min(i, width - 1));
      return static_cast<double>(grey[n]);
    };
    const double upper = std::lerp(pixel(x, y), pixel(x + 1, y), column - x);
    const double lower = std::lerp(pixel(x, y + 1), pixel(x + 1, y + 1), column - x);
    return 1 - (1 - slowest) * std::lerp(upper, lower, row - y) / 255;
  }
};

}  // namespace footlight
