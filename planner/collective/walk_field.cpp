// SPDX-License-Identifier: Apache-2.0
#include "planner/collective/walk_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace footlight::planner::collective {
namespace {

constexpr double kReach = 2.3;  ///< pitches that one step may be long
/// What is rounded in sums of steps.
constexpr double kRounding = 1e-5;

}  // namespace

WalkField::WalkField(const Ways& ways) : steps_(ways, kReach * ways.grid().pitch_m()) {
  const double widest = ways.grid().kind() == GridKind::square ? std::atan(0.5) : std::numbers::pi / 6;
  longest_ = 1 / std::cos(widest / 2);
}

double WalkField::length_m(double steps_m, double straight_m) const {
  if (!std::isfinite(steps_m)) return steps_m;
  return std::max(straight_m, steps_m / longest_);
}

std::vector<Point> WalkField::way(Point from, Point to_point) const {
  const Ways& ways = steps_.ways();
  if (ways.straight(from, to_point)) return {from, to_point};
  const Grid& grid = ways.grid();
  const CellIndex start = grid.nearest(from);
  const CellIndex goal = grid.nearest(to_point);
  const std::vector<float> away = to(goal);
  if (!std::isfinite(away[start.at()])) return {};
  std::vector<Point> corners{from};
  if (from != grid.centre(start)) corners.push_back(grid.centre(start));
  for (std::uint32_t cell = start.value(); cell != goal.value();) {
    std::uint32_t best = cell;
    double least = std::numeric_limits<double>::infinity();
    steps_.each_next(cell, [&, here_m = away[cell]](std::uint32_t next, float step_m) {
      const double length_m = double{away[next]} + double{step_m};
      if (length_m < least - kRounding && away[next] < here_m) {
        least = length_m;
        best = next;
      }
    });
    if (best == cell) return {};
    cell = best;
    corners.push_back(grid.centre(CellIndex(cell)));
  }
  if (corners.back() != to_point) corners.push_back(to_point);
  return ways.taut(std::move(corners));
}

}  // namespace footlight::planner::collective
