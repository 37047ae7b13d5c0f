// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/step_distance.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>

namespace footlight::planner {
namespace {

constexpr std::uint16_t kFar = std::numeric_limits<std::uint16_t>::max();

int floor_half(int value) { return value >= 0 ? value / 2 : -((1 - value) / 2); }

/// Rows are shifted to the left by half a cell each, so that two of the six directions are the axes.
int hexagonal_steps(Cell a, Cell b) {
  const int dr = b.row - a.row;
  const int dq = (b.column - floor_half(b.row)) - (a.column - floor_half(a.row));
  return (std::abs(dq) + std::abs(dr) + std::abs(dq + dr)) / 2;
}

/// Each step crosses one line of one of three families: the rows, and the two that lean.
int triangular_steps(Cell a, Cell b) {
  const auto left_lean = [](Cell c) { return floor_half(c.column + c.row + 1); };
  const auto right_lean = [](Cell c) { return floor_half(c.column - c.row); };
  return std::abs(a.row - b.row) + std::abs(left_lean(a) - left_lean(b)) + std::abs(right_lean(a) - right_lean(b));
}

}  // namespace

int steps_between(GridKind kind, Cell a, Cell b) {
  switch (kind) {
    case GridKind::hexagonal:
      return hexagonal_steps(a, b);
    case GridKind::triangular:
      return triangular_steps(a, b);
    case GridKind::square:
      break;
  }
  return std::abs(a.column - b.column) + std::abs(a.row - b.row);
}

StepDistance::StepDistance(const Ways& ways) : ways_(ways), grid_(ways.grid()), open_(ways.open()) {
  if (open_) return;
  link_cells();
  if (grid_.kind() == GridKind::square) count_blocked();
}

void StepDistance::link_cells() {
  links_.resize(static_cast<std::size_t>(grid_.size()));
  for (std::size_t cell = 0; cell < links_.size(); ++cell) {
    links_[cell].fill(-1);
    const CellIndex from = CellIndex::of(cell);
    if (!ways_.can_stand(from)) continue;
    std::size_t count = 0;
    for (const CellIndex to : grid_.neighbours(from)) {
      if (!ways_.can_stand(to) || !ways_.straight(grid_.centre(from), grid_.centre(to))) continue;
      links_[cell][count++] = static_cast<std::int32_t>(to.value());
    }
  }
}

void StepDistance::count_blocked() {
  const auto width = static_cast<std::size_t>(grid_.columns()) + 1;
  blocked_sums_.assign(width * (static_cast<std::size_t>(grid_.rows()) + 1), 0);
  for (int row = 0; row < grid_.rows(); ++row) {
    std::uint32_t sum = 0;
    for (int column = 0; column < grid_.columns(); ++column) {
      // A cell with a way missing counts as blocked: the rectangle must be free to walk, not only to stand in.
      const auto& links = links_[index(column, row)];
      const auto ways = std::count_if(links.begin(), links.end(), [](std::int32_t to) { return to >= 0; });
      const auto all = static_cast<std::ptrdiff_t>(grid_.neighbours(grid_.index({column, row})).size());
      sum += ways < all ? 1 : 0;
      const std::size_t at = static_cast<std::size_t>(row + 1) * width + static_cast<std::size_t>(column) + 1;
      blocked_sums_[at] = blocked_sums_[at - width] + sum;
    }
  }
}

bool StepDistance::free_rectangle(const Walker& walker) const {
  if (blocked_sums_.empty()) return false;
  const auto width = static_cast<std::size_t>(grid_.columns()) + 1;
  const auto sum = [&](int column, int row) {
    return blocked_sums_[static_cast<std::size_t>(row) * width + static_cast<std::size_t>(column)];
  };
  const auto [x0, x1] = std::minmax(walker.column, walker.goal_column);
  const auto [y0, y1] = std::minmax(walker.row, walker.goal_row);
  return sum(x1 + 1, y1 + 1) - sum(x0, y1 + 1) - sum(x1 + 1, y0) + sum(x0, y0) == 0;
}

const StepDistance::Field& StepDistance::field(std::size_t goal) {
  const auto [at, is_new] = fields_.try_emplace(goal);
  Field& steps = at->second;
  if (!is_new) return steps;
  steps.assign(links_.size(), kFar);
  std::vector<std::int32_t> here{static_cast<std::int32_t>(goal)};
  std::vector<std::int32_t> next;
  steps[goal] = 0;
  for (std::uint16_t depth = 1; !here.empty() && depth < kFar; ++depth) {
    next.clear();
    for (const std::int32_t cell : here) {
      for (const std::int32_t to : links_[static_cast<std::size_t>(cell)]) {
        if (to < 0 || steps[static_cast<std::size_t>(to)] != kFar) continue;
        steps[static_cast<std::size_t>(to)] = depth;
        next.push_back(to);
      }
    }
    here.swap(next);
  }
  return steps;
}

bool StepDistance::reachable(const Walker& walker) {
  if (open_ || walker.home() || free_rectangle(walker)) return true;
  if ((fields_.size() + 1) * links_.size() > kMostKept) return false;
  return field(index(walker.goal_column, walker.goal_row))[index(walker.column, walker.row)] != kFar;
}

int StepDistance::steps(CellIndex from, CellIndex goal) {
  if (open_) return steps_between(grid_.kind(), grid_.cell(from), grid_.cell(goal));
  return field(goal.at())[from.at()];
}

bool StepDistance::linked(CellIndex from, CellIndex to) const {
  if (open_) return true;
  const auto& links = links_[from.at()];
  return std::find(links.begin(), links.end(), static_cast<std::int32_t>(to.value())) != links.end();
}

NextCells StepDistance::nearer(const Walker& walker) {
  NextCells next;
  const std::size_t here = index(walker.column, walker.row);
  const Cell goal{walker.goal_column, walker.goal_row};
  if (open_ || free_rectangle(walker)) {
    const int steps = steps_between(grid_.kind(), {walker.column, walker.row}, goal);
    for (const CellIndex to : grid_.neighbours(CellIndex::of(here))) {
      if (steps_between(grid_.kind(), grid_.cell(to), goal) < steps) next.add(static_cast<std::int32_t>(to.value()));
    }
    return next;
  }
  const Field& steps = field(index(goal.column, goal.row));
  for (const std::int32_t to : links_[here]) {
    if (to >= 0 && steps[static_cast<std::size_t>(to)] < steps[here]) next.add(to);
  }
  return next;
}

}  // namespace footlight::planner
