// SPDX-License-Identifier: Apache-2.0
#include "planner/painted/way_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

namespace footlight::planner {
namespace {

constexpr double kBeside_px = 1.2;
constexpr double kFar = std::numeric_limits<double>::infinity();

double value(const Raster<double>& field, int x, int y) { return field.inside(x, y) ? field.at(x, y) : kFar; }

/// Upwind solution of |grad u| = 1 from what is known around.
double solved(const Raster<double>& field, int x, int y) {
  const double a = std::min(value(field, x - 1, y), value(field, x + 1, y));
  const double b = std::min(value(field, x, y - 1), value(field, x, y + 1));
  if (std::isinf(a) || std::isinf(b) || std::abs(a - b) >= 1) return std::min(a, b) + 1;
  return (a + b + std::sqrt(2 - (a - b) * (a - b))) / 2;
}

}  // namespace

WayField way_field(const PixelSet& blocked, const PixelSet& goal) {
  WayField out{Raster<double>(blocked.width, blocked.height, kFar), Raster<Point>(blocked.width, blocked.height)};
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  std::vector<char> settled(goal.cells.size(), 0);
  for (std::size_t i = 0; i < goal.cells.size(); ++i) {
    if (goal.cells[i] == 0 || blocked.cells[i] != 0) continue;
    out.length_px.cells[i] = 0;
    open.emplace(0.0, i);
  }
  constexpr int kSteps[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
  while (!open.empty()) {
    const std::size_t at = open.top().second;
    open.pop();
    if (settled[at] != 0) continue;
    settled[at] = 1;
    const int x = static_cast<int>(at % static_cast<std::size_t>(goal.width));
    const int y = static_cast<int>(at / static_cast<std::size_t>(goal.width));
    for (const auto& step : kSteps) {
      const int nx = x + step[0];
      const int ny = y + step[1];
      if (!goal.inside(nx, ny) || blocked.at(nx, ny) != 0 || settled[goal.index(nx, ny)] != 0) continue;
      const double length = solved(out.length_px, nx, ny);
      if (length >= out.length_px.at(nx, ny)) continue;
      out.length_px.at(nx, ny) = length;
      open.emplace(length, goal.index(nx, ny));
    }
  }
  for (int y = 0; y < goal.height; ++y) {
    for (int x = 0; x < goal.width; ++x) {
      const double here = out.length_px.at(x, y);
      if (std::isinf(here) || here == 0) continue;
      const double left = value(out.length_px, x - 1, y);
      const double right = value(out.length_px, x + 1, y);
      const double up = value(out.length_px, x, y - 1);
      const double down = value(out.length_px, x, y + 1);
      const double dx = std::min(left, right) < here ? (left < right ? -(here - left) : here - right) : 0;
      const double dy = std::min(up, down) < here ? (up < down ? -(here - up) : here - down) : 0;
      const double size = std::hypot(dx, dy);
      if (size > 0) out.direction.at(x, y) = {dx / size, dy / size};
    }
  }
  return out;
}

bool sees(const Raster<double>& away, Point from, Point to) {
  const double whole = distance(from, to);
  double walked = 0;
  while (walked < whole) {
    const Point here = from + walked / whole * (to - from);
    const int x = std::clamp(static_cast<int>(here.x), 0, away.width - 1);
    const int y = std::clamp(static_cast<int>(here.y), 0, away.height - 1);
    const double free = away.at(x, y);
    if (free <= (walked > 1 ? kBeside_px : 0)) return false;
    // The middle of this pixel is so far from anything blocked, here is at most sqrt(1/2) beside it.
    walked += std::max(0.5, free - 1.5);
  }
  return true;
}

}  // namespace footlight::planner
