// SPDX-License-Identifier: Apache-2.0
#include "planner/formation/formation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <tuple>

namespace footlight::planner {

std::vector<std::uint32_t> even_ranks(const Grid& grid) {
  std::vector<std::uint32_t> ranks(static_cast<std::size_t>(grid.size()));
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    const Cell cell = grid.cell(CellIndex::of(i));
    std::uint32_t rank = 0;
    for (unsigned bit = 0; bit < 6; ++bit) {
      const auto x = (static_cast<std::uint32_t>(cell.column) >> bit) & 1U;
      const auto y = (static_cast<std::uint32_t>(cell.row) >> bit) & 1U;
      rank = rank * 4 + ((x ^ y) * 2 + y);
    }
    ranks[i] = rank;
  }
  return ranks;
}

std::vector<double> distance_to(const Grid& grid, std::span<const CellIndex> from) {
  const std::size_t size = static_cast<std::size_t>(grid.size());
  std::vector<double> distance(size, std::numeric_limits<double>::infinity());
  std::vector<CellIndex> nearest(size);
  using Entry = std::tuple<double, CellIndex, CellIndex>;  // distance, cell, nearest source
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  for (const CellIndex cell : from) open.emplace(0.0, cell, cell);
  while (!open.empty()) {
    const auto [d, cell, source] = open.top();
    open.pop();
    if (d >= distance[cell.at()]) continue;
    distance[cell.at()] = d;
    for (const CellIndex next : grid.within(grid.centre(cell), 1.75 * grid.pitch_m())) {
      const double further = footlight::distance(grid.centre(next), grid.centre(source));
      if (further < distance[next.at()]) open.emplace(further, next, source);
    }
  }
  return distance;
}

Drawing draw(const DrawingTask& task) {
  const std::size_t size = task.shares->size();
  std::vector<CellIndex> order;
  std::vector<CellIndex> core = {task.when_blank.begin(), task.when_blank.end()};
  double area = 0;
  Drawing drawing;
  for (std::size_t i = 0; i < size; ++i) {
    if ((*task.usable)[i] == 0) continue;
    order.push_back(CellIndex::of(i));
    area += (*task.shares)[i];
    drawing.touched += (*task.shares)[i] > 0 ? 1 : 0;
  }
  drawing.full = area > 0 ? std::max(1, static_cast<int>(std::lround(area))) : 0;
  const int wanted =
      std::min(std::clamp(drawing.full, std::min(task.least, task.most), task.most), static_cast<int>(order.size()));
  const auto share = [&](CellIndex cell) { return (*task.shares)[cell.at()]; };
  if (drawing.touched > 0) {
    core.clear();
    for (const CellIndex cell : order) {
      if (share(cell) > 0) core.push_back(cell);
    }
  }
  std::vector<double> away(size, 0.0);
  if (wanted > drawing.touched) away = distance_to(*task.grid, core);
  std::sort(order.begin(), order.end(), [&](CellIndex a, CellIndex b) {
    return std::tuple(-share(a), away[a.at()], (*task.ranks)[a.at()], a) <
           std::tuple(-share(b), away[b.at()], (*task.ranks)[b.at()], b);
  });
  order.resize(static_cast<std::size_t>(wanted));
  std::sort(order.begin(), order.end());
  drawing.cells = std::move(order);
  drawing.in_picture = std::min(drawing.touched, wanted);
  return drawing;
}

std::vector<std::vector<CellIndex>> waiting_places(const WaitingTask& task) {
  std::vector<char> in_any(static_cast<std::size_t>(task.grid->size()), 0);
  std::vector<CellIndex> all;
  for (const Drawing& drawing : *task.drawings) {
    for (const CellIndex cell : drawing.cells) in_any[cell.at()] = 1;
  }
  for (std::size_t i = 0; i < in_any.size(); ++i) {
    if (in_any[i] != 0) all.push_back(CellIndex::of(i));
  }
  const std::vector<double> away_from_all = distance_to(*task.grid, all);
  std::vector<CellIndex> free = *task.reserve;
  std::vector<CellIndex> waiting;
  std::vector<std::vector<CellIndex>> out;
  for (const Drawing& drawing : *task.drawings) {
    const std::size_t wanted = static_cast<std::size_t>(task.people) - drawing.cells.size();
    FL_CHECK(wanted <= task.reserve->size());
    const bool first = out.empty();
    const std::vector<double> away =
        first || drawing.cells.empty() ? away_from_all : distance_to(*task.grid, drawing.cells);
    const auto nearer = [&](CellIndex a, CellIndex b) {
      return std::tuple(std::round(away[a.at()] * 1e6), a) < std::tuple(std::round(away[b.at()] * 1e6), b);
    };
    auto& from = waiting.size() > wanted ? waiting : free;
    auto& to = waiting.size() > wanted ? free : waiting;
    const std::size_t moved = waiting.size() > wanted ? waiting.size() - wanted : wanted - waiting.size();
    std::sort(from.begin(), from.end(), nearer);
    const auto end = from.begin() + static_cast<std::ptrdiff_t>(moved);
    to.insert(to.end(), from.begin(), end);
    from.erase(from.begin(), end);
    std::sort(waiting.begin(), waiting.end());
    out.push_back(waiting);
  }
  return out;
}

}  // namespace footlight::planner
