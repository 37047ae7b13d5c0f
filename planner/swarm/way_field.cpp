// SPDX-License-Identifier: Apache-2.0
#include "planner/swarm/way_field.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace footlight::planner::swarm {
namespace {

/// So many cells along the way one looks ahead.
constexpr int kLookAhead = 12;

/// Cells from which some walk to a neighbour might touch something blocked.
std::vector<char> near_blocked(const Ways& ways, double reach_m) {
  const Grid& grid = ways.grid();
  double cell_radius_m = 0;
  for (const Point corner : grid.outline(CellIndex(0))) {
    cell_radius_m = std::max(cell_radius_m, distance(corner, grid.centre(CellIndex(0))));
  }
  std::vector<char> out(static_cast<std::size_t>(grid.size()), 0);
  for (const CellIndex cell : ways.blocked()) {
    for (const CellIndex near : grid.within(grid.centre(cell), ways.keep_m() + cell_radius_m + reach_m)) {
      out[near.at()] = 1;
    }
  }
  return out;
}

}  // namespace

Passages::Passages(const Ways& ways) : ways_(&ways) {
  const Grid& grid = ways.grid();
  const auto cells = static_cast<std::uint32_t>(grid.size());
  const double reach_m = (grid.kind() == GridKind::square ? 1.5 : 1.8) * grid.pitch_m();
  const std::vector<char> looked_at = near_blocked(ways, reach_m);
  start_.push_back(0);
  for (std::uint32_t cell = 0; cell < cells; ++cell) {
    if (ways.can_stand(CellIndex(cell))) {
      const Point here = grid.centre(CellIndex(cell));
      for (const CellIndex next : grid.within(here, reach_m)) {
        if (next.value() == cell || !ways.can_stand(next)) continue;
        if (looked_at[cell] == 0 || ways.straight(here, grid.centre(next))) next_.push_back(next.value());
      }
    }
    start_.push_back(static_cast<std::uint32_t>(next_.size()));
  }
  part_.assign(cells, kNoCell);
  std::vector<std::uint32_t> open;
  std::uint32_t parts = 0;
  for (std::uint32_t first = 0; first < cells; ++first) {
    if (part_[first] != kNoCell || !ways.can_stand(CellIndex(first))) continue;
    part_[first] = parts;
    open.push_back(first);
    while (!open.empty()) {
      const std::uint32_t cell = open.back();
      open.pop_back();
      each_next(cell, [&](std::uint32_t next) {
        if (part_[next] != kNoCell) return;
        part_[next] = parts;
        open.push_back(next);
      });
    }
    ++parts;
  }
}

CellIndex Passages::nearest_in(std::uint32_t part, Point at) const {
  const Grid& grid = ways_->grid();
  CellIndex best = grid.nearest(at);
  if (part_[best.at()] == part) return best;
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t cell = 0; cell < part_.size(); ++cell) {
    if (part_[cell] != part) continue;
    const double squared = squared_length(grid.centre(CellIndex(cell)) - at);
    if (squared < least) {
      least = squared;
      best = CellIndex(cell);
    }
  }
  return best;
}

WayField::WayField(const Passages& passages, CellIndex goal)
    : passages_(&passages),
      next_(static_cast<std::size_t>(passages.ways().grid().size()), kNoCell),
      rest_m_(next_.size(), std::numeric_limits<float>::infinity()) {
  const Grid& grid = passages.ways().grid();
  using Entry = std::pair<float, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  rest_m_[goal.at()] = 0;
  next_[goal.at()] = goal.value();
  open.emplace(0.0F, goal.value());
  while (!open.empty()) {
    const auto [rest_m, cell] = open.top();
    open.pop();
    if (rest_m > rest_m_[cell]) continue;
    const Point here = grid.centre(CellIndex(cell));
    passages.each_next(cell, [&, rest = rest_m, from = cell](std::uint32_t before) {
      const auto there_m = rest + static_cast<float>(distance(here, grid.centre(CellIndex(before))));
      if (there_m >= rest_m_[before]) return;
      rest_m_[before] = there_m;
      next_[before] = from;
      open.emplace(there_m, before);
    });
  }
}

std::uint32_t WayField::enter(Point at) const {
  const Ways& ways = passages_->ways();
  const Grid& grid = ways.grid();
  double least_m = std::numeric_limits<double>::infinity();
  std::uint32_t best = kNoCell;
  for (const CellIndex cell : grid.within(at, 2 * grid.pitch_m())) {
    const double way_m = distance(at, grid.centre(cell)) + static_cast<double>(rest_m_[cell.at()]);
    if (way_m >= least_m || !ways.straight(at, grid.centre(cell))) continue;
    least_m = way_m;
    best = cell.value();
  }
  return best;
}

WayField::Toward WayField::toward(Point at) const {
  const Ways& ways = passages_->ways();
  const Grid& grid = ways.grid();
  std::uint32_t cell = grid.nearest(at).value();
  if (next_[cell] == kNoCell) cell = enter(at);
  if (cell == kNoCell) return {at, 0};
  Toward out{grid.centre(CellIndex(cell)), static_cast<double>(rest_m_[cell])};
  for (int ahead = 0; ahead < kLookAhead && next_[cell] != cell; ++ahead) {
    cell = next_[cell];
    const Point there = grid.centre(CellIndex(cell));
    if (!ways.straight(at, there)) break;
    out = {there, static_cast<double>(rest_m_[cell])};
  }
  return out;
}

}  // namespace footlight::planner::swarm
