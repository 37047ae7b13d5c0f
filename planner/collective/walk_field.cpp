// SPDX-License-Identifier: Apache-2.0
#include "planner/collective/walk_field.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <queue>
#include <utility>

namespace footlight::planner::collective {
namespace {

constexpr float kNoWay = std::numeric_limits<float>::infinity();
constexpr double kReach = 2.3;  ///< pitches that one step may be long
/// What is rounded in sums of steps.
constexpr double kRounding = 1e-5;

/// Cells from which a step could touch something blocked.
std::vector<char> cells_near_blocked(const Ways& ways) {
  const Grid& grid = ways.grid();
  std::vector<char> near(static_cast<std::size_t>(grid.size()), 0);
  const double reach_m = (kReach + 1) * grid.pitch_m() + ways.keep_m();
  for (const CellIndex blocked : ways.blocked()) {
    for (const CellIndex cell : grid.within(grid.centre(blocked), reach_m)) near[cell.at()] = 1;
  }
  return near;
}

}  // namespace

WalkField::WalkField(const Ways& ways) : ways_(&ways) {
  const Grid& grid = ways.grid();
  const double widest = grid.kind() == GridKind::square ? std::atan(0.5) : std::numbers::pi / 6;
  longest_ = 1 / std::cos(widest / 2);
  const std::vector<char> near = cells_near_blocked(ways);
  first_.push_back(0);
  for (int i = 0; i < grid.size(); ++i) {
    const CellIndex cell = CellIndex::of(i);
    if (ways.can_stand(cell)) {
      const Point here = grid.centre(cell);
      for (const CellIndex other : grid.within(here, kReach * grid.pitch_m())) {
        if (other == cell || !ways.can_stand(other)) continue;
        const Point there = grid.centre(other);
        if (near[cell.at()] != 0 && !ways.straight(here, there)) continue;
        next_.push_back(other.value());
        step_m_.push_back(static_cast<float>(distance(here, there)));
      }
    }
    first_.push_back(static_cast<std::uint32_t>(next_.size()));
  }
}

std::vector<float> WalkField::to(CellIndex goal) const {
  std::vector<float> away(first_.size() - 1, kNoWay);
  using Entry = std::pair<float, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  away[goal.at()] = 0;
  open.emplace(0.0F, goal.value());
  while (!open.empty()) {
    const auto [here_m, cell] = open.top();
    open.pop();
    if (here_m > away[cell]) continue;
    for (std::uint32_t k = first_[cell]; k < first_[cell + 1]; ++k) {
      const float there_m = here_m + step_m_[k];
      if (there_m >= away[next_[k]]) continue;
      away[next_[k]] = there_m;
      open.emplace(there_m, next_[k]);
    }
  }
  return away;
}

double WalkField::length_m(double steps_m, double straight_m) const {
  if (!std::isfinite(steps_m)) return steps_m;
  return std::max(straight_m, steps_m / longest_);
}

std::vector<Point> WalkField::way(Point from, Point to_point) const {
  if (ways_->straight(from, to_point)) return {from, to_point};
  const Grid& grid = ways_->grid();
  const CellIndex start = grid.nearest(from);
  const CellIndex goal = grid.nearest(to_point);
  const std::vector<float> away = to(goal);
  if (!std::isfinite(away[start.at()])) return {};
  std::vector<Point> corners{from};
  if (from != grid.centre(start)) corners.push_back(grid.centre(start));
  for (std::uint32_t cell = start.value(); cell != goal.value();) {
    std::uint32_t best = cell;
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t k = first_[cell]; k < first_[cell + 1]; ++k) {
      const double length_m = double{away[next_[k]]} + double{step_m_[k]};
      if (length_m < least - kRounding && away[next_[k]] < away[cell]) {
        least = length_m;
        best = next_[k];
      }
    }
    if (best == cell) return {};
    cell = best;
    corners.push_back(grid.centre(CellIndex(cell)));
  }
  if (corners.back() != to_point) corners.push_back(to_point);
  // Drawn taut: as far as can be seen.
  std::vector<Point> taut{from};
  for (std::size_t at = 0; at + 1 < corners.size();) {
    std::size_t next = corners.size() - 1;
    while (next > at + 1 && !ways_->straight(corners[at], corners[next])) --next;
    taut.push_back(corners[next]);
    at = next;
  }
  return taut;
}

}  // namespace footlight::planner::collective
