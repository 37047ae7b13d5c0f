// SPDX-License-Identifier: Apache-2.0
#include "planner/motion/cell_steps.hpp"

#include <functional>
#include <queue>
#include <utility>

namespace footlight::planner {
namespace {

/// Cells from which a step could touch something blocked.
std::vector<char> cells_near_blocked(const Ways& ways, double reach_m) {
  const Grid& grid = ways.grid();
  std::vector<char> near(static_cast<std::size_t>(grid.size()), 0);
  const double touch_m = reach_m + ways.keep_m() + ways.cell_radius_m();
  for (const CellIndex blocked : ways.blocked()) {
    for (const CellIndex cell : grid.within(grid.centre(blocked), touch_m)) near[cell.at()] = 1;
  }
  return near;
}

}  // namespace

CellSteps::CellSteps(const Ways& ways, double reach_m) : ways_(&ways) {
  const Grid& grid = ways.grid();
  const std::vector<char> near = cells_near_blocked(ways, reach_m);
  first_.push_back(0);
  for (int i = 0; i < grid.size(); ++i) {
    const CellIndex cell = CellIndex::of(i);
    if (ways.can_stand(cell)) {
      const Point here = grid.centre(cell);
      for (const CellIndex other : grid.within(here, reach_m)) {
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

std::vector<float> CellSteps::lengths_to(CellIndex goal, std::vector<std::uint32_t>* toward) const {
  std::vector<float> length_m(cells(), std::numeric_limits<float>::infinity());
  if (toward != nullptr) toward->assign(cells(), kNoCell);
  using Entry = std::pair<float, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  length_m[goal.at()] = 0;
  if (toward != nullptr) (*toward)[goal.at()] = goal.value();
  open.emplace(0.0F, goal.value());
  while (!open.empty()) {
    const float here_m = open.top().first;
    const std::uint32_t cell = open.top().second;
    open.pop();
    if (here_m > length_m[cell]) continue;
    each_next(cell, [&](std::uint32_t before, float step_m) {
      const float there_m = here_m + step_m;
      if (there_m >= length_m[before]) return;
      length_m[before] = there_m;
      if (toward != nullptr) (*toward)[before] = cell;
      open.emplace(there_m, before);
    });
  }
  return length_m;
}

std::vector<std::uint32_t> CellSteps::parts() const {
  std::vector<std::uint32_t> part(cells(), kNoCell);
  std::vector<std::uint32_t> open;
  std::uint32_t parts = 0;
  for (std::uint32_t first = 0; first < part.size(); ++first) {
    if (part[first] != kNoCell || !ways_->can_stand(CellIndex(first))) continue;
    part[first] = parts;
    open.push_back(first);
    while (!open.empty()) {
      const std::uint32_t cell = open.back();
      open.pop_back();
      each_next(cell, [&](std::uint32_t next, float) {
        if (part[next] != kNoCell) return;
        part[next] = parts;
        open.push_back(next);
      });
    }
    ++parts;
  }
  return part;
}

}  // namespace footlight::planner
