// SPDX-License-Identifier: Apache-2.0
#include "planner/hierarchy/regions.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>

namespace footlight::planner {
namespace {

constexpr std::uint32_t kNobody = 0xFFFFFFFFU;

/// Steps to the neighbours of a cell, which depend on whether its column and its row are odd.
class NeighbourSteps {
 public:
  explicit NeighbourSteps(const Grid& grid) {
    // On a small floor of the same kind: a cell in its middle has all neighbours.
    const Grid small = *Grid::make(grid.kind(), 8, 8, grid.pitch_m());
    for (int odd = 0; odd < 4; ++odd) {
      const Cell middle{4 + odd % 2, 4 + odd / 2};
      for (const CellIndex next : small.neighbours(small.index(middle))) {
        const Cell cell = small.cell(next);
        steps_[static_cast<std::size_t>(odd)].push_back({cell.column - middle.column, cell.row - middle.row});
      }
    }
  }
  [[nodiscard]] const std::vector<Cell>& from(Cell cell) const {
    return steps_[static_cast<std::size_t>(cell.column % 2 + 2 * (cell.row % 2))];
  }

 private:
  std::array<std::vector<Cell>, 4> steps_;
};

/// The people who have no region yet and how they are connected. People are numbered in the order of their cells.
class Remaining {
 public:
  static constexpr std::size_t kMost = 6;  ///< neighbours

  Remaining(const Grid& grid, std::span<const CellIndex> cells) : order_(cells.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
    std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) { return cells[a] < cells[b]; });
    std::vector<std::uint32_t> at_cell(static_cast<std::size_t>(grid.size()), kNobody);
    for (std::uint32_t n = 0; n < order_.size(); ++n) at_cell[cells[order_[n]].at()] = n;
    const NeighbourSteps steps(grid);
    people_.resize(order_.size());
    words_ = (order_.size() + 63) / 64;
    for (auto& boundary : boundary_) boundary.assign(words_, 0);
    for (std::uint32_t n = 0; n < order_.size(); ++n) {
      Person& person = people_[n];
      const Cell cell = grid.cell(cells[order_[n]]);
      person.at = grid.centre(cell);
      for (const Cell step : steps.from(cell)) {
        const Cell next{cell.column + step.column, cell.row + step.row};
        if (!grid.contains(next)) continue;
        const std::uint32_t other = at_cell[grid.index(next).at()];
        if (other != kNobody) person.neighbours[person.many++] = other;
      }
      person.left = person.many;
      flip(n);
    }
    count_ = order_.size();
  }

  [[nodiscard]] bool empty() const { return count_ == 0; }
  [[nodiscard]] bool taken(std::uint32_t n) const { return people_[n].taken; }
  [[nodiscard]] Point at(std::uint32_t n) const { return people_[n].at; }
  /// Position in the list that was divided.
  [[nodiscard]] std::uint32_t position(std::uint32_t n) const { return order_[n]; }
  [[nodiscard]] std::span<const std::uint32_t> neighbours(std::uint32_t n) const {
    return std::span(people_[n].neighbours).first(people_[n].many);
  }

  /// Of those with the fewest neighbours left the first.
  [[nodiscard]] std::uint32_t seed() const {
    for (const auto& boundary : boundary_) {
      for (std::size_t w = 0; w < words_; ++w) {
        if (boundary[w] != 0)
          return static_cast<std::uint32_t>(64 * w) + static_cast<std::uint32_t>(std::countr_zero(boundary[w]));
      }
    }
    return kNobody;
  }

  void take(std::uint32_t n) {
    flip(n);
    people_[n].taken = true;
    --count_;
    for (const std::uint32_t next : neighbours(n)) {
      if (people_[next].taken) continue;
      flip(next);
      --people_[next].left;
      flip(next);
    }
  }

  /// Whether somebody is put on the list of whoever may be next in a region for the first time.
  bool reach(std::uint32_t n, std::uint32_t region) {
    const bool first = people_[n].reached != region;
    people_[n].reached = region;
    return first;
  }

 private:
  struct Person {
    Point at;
    std::array<std::uint32_t, kMost> neighbours;
    std::uint32_t reached = kNobody;
    std::uint8_t many = 0;
    std::uint8_t left = 0;  ///< neighbours without a region
    bool taken = false;
  };
  /// Puts somebody into the set of those with as many neighbours left, or takes her out.
  void flip(std::uint32_t n) { boundary_[people_[n].left][n / 64] ^= std::uint64_t{1} << (n % 64); }

  std::vector<std::uint32_t> order_;
  std::vector<Person> people_;
  std::array<std::vector<std::uint64_t>, kMost + 1> boundary_;  ///< one bit a person
  std::size_t words_ = 0;
  std::size_t count_ = 0;
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

Region grow_one(const RegionLimits& limits, std::uint32_t number, Remaining& left) {
  Region region;
  Spread spread;
  std::vector<std::uint32_t> frontier{left.seed()};
  left.reach(frontier.front(), number);
  while (!frontier.empty() && static_cast<int>(region.members.size()) < limits.most_people) {
    const Point anchor = region.members.empty() ? left.at(frontier.front()) : spread.mean();
    std::size_t nearest = 0;
    double least_m2 = squared_length(left.at(frontier[0]) - anchor);
    for (std::size_t f = 1; f < frontier.size(); ++f) {
      const double here_m2 = squared_length(left.at(frontier[f]) - anchor);
      if (here_m2 > least_m2 || (here_m2 == least_m2 && frontier[f] > frontier[nearest])) continue;
      nearest = f;
      least_m2 = here_m2;
    }
    const std::uint32_t next = frontier[nearest];
    Spread grown = spread;
    grown.add(left.at(next));
    if (!region.members.empty() && grown.variance() > limits.variance_m2) break;
    spread = grown;
    frontier[nearest] = frontier.back();
    frontier.pop_back();
    region.members.push_back(left.position(next));
    left.take(next);
    for (const std::uint32_t neighbour : left.neighbours(next)) {
      if (!left.taken(neighbour) && left.reach(neighbour, number)) frontier.push_back(neighbour);
    }
  }
  region.anchor = spread.mean();
  return region;
}

}  // namespace

std::vector<Region> grow_regions(const Grid& grid, std::span<const CellIndex> cells, const RegionLimits& limits) {
  Remaining left(grid, cells);
  std::vector<Region> regions;
  while (!left.empty()) regions.push_back(grow_one(limits, static_cast<std::uint32_t>(regions.size()), left));
  return regions;
}

}  // namespace footlight::planner
