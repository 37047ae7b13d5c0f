// SPDX-License-Identifier: Apache-2.0
#include "planner/hierarchy/regions.hpp"

#include <algorithm>
#include <set>
#include <tuple>

namespace footlight::planner {
namespace {

/// The people who have no region yet and how they are connected.
class Remaining {
 public:
  Remaining(const Grid& grid, std::span<const CellIndex> cells)
      : cells_(cells), neighbours_(cells.size()), degree_(cells.size()), taken_(cells.size(), 0) {
    std::vector<std::pair<CellIndex, std::uint32_t>> by_cell;
    for (std::uint32_t i = 0; i < cells.size(); ++i) by_cell.emplace_back(cells[i], i);
    std::sort(by_cell.begin(), by_cell.end());
    for (std::uint32_t i = 0; i < cells.size(); ++i) {
      for (const CellIndex next : grid.neighbours(cells[i])) {
        const auto at = std::lower_bound(by_cell.begin(), by_cell.end(), std::pair(next, std::uint32_t{0}));
        if (at != by_cell.end() && at->first == next) neighbours_[i].push_back(at->second);
      }
      degree_[i] = static_cast<int>(neighbours_[i].size());
      boundary_.emplace(degree_[i], cells[i], i);
    }
  }

  [[nodiscard]] bool empty() const { return boundary_.empty(); }
  [[nodiscard]] std::uint32_t seed() const { return std::get<2>(*boundary_.begin()); }
  [[nodiscard]] bool taken(std::uint32_t i) const { return taken_[i] != 0; }
  [[nodiscard]] const std::vector<std::uint32_t>& neighbours(std::uint32_t i) const { return neighbours_[i]; }

  void take(std::uint32_t i) {
    boundary_.erase({degree_[i], cells_[i], i});
    taken_[i] = 1;
    for (const std::uint32_t next : neighbours_[i]) {
      if (taken_[next] != 0) continue;
      boundary_.erase({degree_[next], cells_[next], next});
      boundary_.emplace(--degree_[next], cells_[next], next);
    }
  }

 private:
  std::span<const CellIndex> cells_;
  std::vector<std::vector<std::uint32_t>> neighbours_;
  std::vector<int> degree_;
  std::vector<char> taken_;
  std::set<std::tuple<int, CellIndex, std::uint32_t>> boundary_;  // fewest neighbours left first
};

/// Mean and mean squared distance from it, one member after the other.
struct Spread {
  double count = 0;
  Point sum;
  double squares = 0;

  void add(Point p) {
    count += 1;
    sum = sum + p;
    squares += squared_length(p);
  }
  [[nodiscard]] Point mean() const { return (1 / count) * sum; }
  [[nodiscard]] double variance() const { return squares / count - squared_length(mean()); }
};

Region grow_one(const Grid& grid, std::span<const CellIndex> cells, const RegionLimits& limits, Remaining& left) {
  Region region;
  Spread spread;
  std::vector<std::uint32_t> frontier{left.seed()};
  while (!frontier.empty() && static_cast<int>(region.members.size()) < limits.most_people) {
    const Point anchor = region.members.empty() ? grid.centre(cells[frontier.front()]) : spread.mean();
    const auto nearest = std::min_element(frontier.begin(), frontier.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::pair(squared_length(grid.centre(cells[a]) - anchor), cells[a]) <
             std::pair(squared_length(grid.centre(cells[b]) - anchor), cells[b]);
    });
    const std::uint32_t next = *nearest;
    Spread grown = spread;
    grown.add(grid.centre(cells[next]));
    if (!region.members.empty() && grown.variance() > limits.variance_m2) break;
    spread = grown;
    frontier.erase(nearest);
    region.members.push_back(next);
    left.take(next);
    for (const std::uint32_t neighbour : left.neighbours(next)) {
      const bool known = std::find(frontier.begin(), frontier.end(), neighbour) != frontier.end();
      if (!left.taken(neighbour) && !known) frontier.push_back(neighbour);
    }
  }
  region.anchor = spread.mean();
  return region;
}

}  // namespace

std::vector<Region> grow_regions(const Grid& grid, std::span<const CellIndex> cells, const RegionLimits& limits) {
  Remaining left(grid, cells);
  std::vector<Region> regions;
  while (!left.empty()) regions.push_back(grow_one(grid, cells, limits, left));
  return regions;
}

}  // namespace footlight::planner
