// SPDX-License-Identifier: Apache-2.0
#include "planner/swarm/way_field.hpp"

#include <limits>

namespace footlight::planner::swarm {
namespace {

/// So many cells along the way one looks ahead.
constexpr int kLookAhead = 12;

}  // namespace

CellIndex Passages::nearest_in(std::uint32_t part, Point at) const {
  const Grid& grid = ways().grid();
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
    : passages_(&passages), rest_m_(passages.steps().lengths_to(goal, &next_)) {}

std::uint32_t WayField::enter(Point at) const {
  const Ways& ways = passages_->ways();
  const Grid& grid = ways.grid();
  double least_m = std::numeric_limits<double>::infinity();
  std::uint32_t best = CellSteps::kNoCell;
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
  if (next_[cell] == CellSteps::kNoCell) cell = enter(at);
  if (cell == CellSteps::kNoCell) return {at, 0};
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
