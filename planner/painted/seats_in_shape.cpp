// SPDX-License-Identifier: Apache-2.0
#include "planner/painted/seats_in_shape.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "core/check.hpp"
#include "planner/assignment/assignment.hpp"

namespace footlight::planner {

std::vector<CellIndex> seats_in_shape(const Grid& grid, const std::vector<Point>& places,
                                      const std::vector<CellIndex>& cells) {
  FL_CHECK(cells.size() >= places.size());
  constexpr std::size_t kFree = std::numeric_limits<std::size_t>::max();
  std::vector<Point> centre;
  for (const CellIndex cell : cells) centre.push_back(grid.centre(cell));
  std::vector<std::vector<std::uint32_t>> wish(places.size());
  std::vector<std::size_t> asked(places.size(), 0);
  std::vector<std::size_t> holder(cells.size(), kFree);
  std::vector<std::size_t> open(places.size());
  std::iota(open.rbegin(), open.rend(), std::size_t{0});
  const auto away = [&](std::size_t p, std::size_t c) { return squared_length(places[p] - centre[c]); };
  while (!open.empty()) {
    const std::size_t p = open.back();
    if (wish[p].empty()) {
      wish[p].resize(cells.size());
      std::iota(wish[p].begin(), wish[p].end(), 0U);
      std::stable_sort(wish[p].begin(), wish[p].end(), [&](auto a, auto b) { return away(p, a) < away(p, b); });
    }
    const std::size_t c = wish[p][asked[p]++];
    if (holder[c] == kFree) {
      open.pop_back();
      holder[c] = p;
    } else if (away(p, c) < away(holder[c], c)) {
      open.back() = holder[c];
      holder[c] = p;
    }
  }
  std::vector<CellIndex> taken;
  std::vector<Point> targets;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (holder[c] == kFree) continue;
    taken.push_back(cells[c]);
    targets.push_back(centre[c]);
  }
  std::vector<CellIndex> out(places.size());
  const auto best = assign(places, targets, WalkCost::squared, std::numeric_limits<double>::infinity());
  FL_CHECK(best.has_value());
  for (std::size_t p = 0; p < places.size(); ++p) out[p] = taken[best->target_of[p]];
  return out;
}

}  // namespace footlight::planner
