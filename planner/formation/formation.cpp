// SPDX-License-Identifier: Apache-2.0
#include "planner/formation/formation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "planner/formation/cell_distance.hpp"

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

namespace {

constexpr double kMillion = 1e6;

/// Orders cells by falling share (in millionths), then by the even pattern, then by index.
std::uint64_t rank_of(double share, std::uint32_t even_rank, std::size_t cell) {
  const auto missing = static_cast<std::uint64_t>(std::llround((1 - share) * kMillion));
  return (missing << 40) | (static_cast<std::uint64_t>(even_rank) << 24) | cell;
}

/// The `wanted` cells with the most picture of those with some, ascending.
std::vector<CellIndex> fullest(const DrawingTask& task, int touched, int wanted) {
  std::vector<std::uint64_t> ranks;
  std::vector<CellIndex> cells;
  ranks.reserve(static_cast<std::size_t>(touched));
  cells.reserve(static_cast<std::size_t>(touched));
  for (std::size_t i = 0; i < task.shares->size(); ++i) {
    const double share = (*task.shares)[i];
    if (share <= 0 || (*task.usable)[i] == 0) continue;
    ranks.push_back(rank_of(share, (*task.ranks)[i], i));
    cells.push_back(CellIndex::of(i));
  }
  if (wanted <= 0) return {};
  if (wanted >= touched) return cells;
  std::vector<std::uint64_t> order = ranks;
  const auto last = order.begin() + (wanted - 1);
  std::nth_element(order.begin(), last, order.end());
  std::size_t kept = 0;
  for (std::size_t n = 0; n < cells.size(); ++n) {
    if (ranks[n] <= *last) cells[kept++] = cells[n];
  }
  cells.resize(kept);
  return cells;
}

/// All cells with picture (or those to start from where there is none) and the usable cells nearest to them.
std::vector<CellIndex> widened(const DrawingTask& task, std::vector<CellIndex> cells, int wanted) {
  CellDistance away(*task.grid);
  std::vector<CellIndex> core = cells;
  if (cells.empty()) core = {task.when_blank.begin(), task.when_blank.end()};
  away.set_to(core);
  struct Wider {
    double away_m;
    std::uint32_t rank;
    CellIndex cell;
  };
  std::vector<Wider> more;
  for (std::size_t i = 0; i < task.shares->size(); ++i) {
    if ((*task.usable)[i] == 0 || (*task.shares)[i] > 0) continue;
    more.push_back({away.of(CellIndex::of(i)), (*task.ranks)[i], CellIndex::of(i)});
  }
  const std::size_t missing = static_cast<std::size_t>(wanted) - cells.size();
  std::sort(more.begin(), more.end(), [](const Wider& a, const Wider& b) {
    return std::tie(a.away_m, a.rank, a.cell) < std::tie(b.away_m, b.rank, b.cell);
  });
  for (std::size_t n = 0; n < missing; ++n) cells.push_back(more[n].cell);
  std::sort(cells.begin(), cells.end());
  return cells;
}

}  // namespace

Drawing draw(const DrawingTask& task) {
  Drawing drawing;
  int usable = 0;
  double area = 0;
  for (std::size_t i = 0; i < task.shares->size(); ++i) {
    if ((*task.usable)[i] == 0) continue;
    ++usable;
    area += (*task.shares)[i];
    drawing.touched += (*task.shares)[i] > 0 ? 1 : 0;
  }
  drawing.full = area > 0 ? std::max(1, static_cast<int>(std::lround(area))) : 0;
  const int wanted = std::min(std::clamp(drawing.full, std::min(task.least, task.most), task.most), usable);
  drawing.cells = fullest(task, drawing.touched, wanted);
  if (wanted > drawing.touched) drawing.cells = widened(task, std::move(drawing.cells), wanted);
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
  CellDistance away(*task.grid);
  away.set_to(all);
  const auto distances = [&](std::span<const CellIndex> cells) {
    std::vector<std::pair<std::int64_t, CellIndex>> out;  // micrometres
    for (const CellIndex cell : cells) {
      const double away_m = away.of(cell);
      out.emplace_back(std::isfinite(away_m) ? std::llround(away_m * 1e6) : std::numeric_limits<std::int64_t>::max(),
                       cell);
    }
    return out;
  };
  std::vector<CellIndex> free = *task.reserve;
  std::vector<CellIndex> waiting;
  std::vector<std::vector<CellIndex>> out;
  for (const Drawing& drawing : *task.drawings) {
    const std::size_t wanted = static_cast<std::size_t>(task.people) - drawing.cells.size();
    FL_CHECK(wanted <= task.reserve->size());
    auto& from = waiting.size() > wanted ? waiting : free;
    auto& to = waiting.size() > wanted ? free : waiting;
    const std::size_t moved = waiting.size() > wanted ? waiting.size() - wanted : wanted - waiting.size();
    if (moved > 0) {
      if (!out.empty()) away.set_to(drawing.cells.empty() ? std::span<const CellIndex>(all) : drawing.cells);
      auto order = distances(from);
      std::sort(order.begin(), order.end());
      for (std::size_t n = 0; n < order.size(); ++n) from[n] = order[n].second;
      const auto end = from.begin() + static_cast<std::ptrdiff_t>(moved);
      to.insert(to.end(), from.begin(), end);
      from.erase(from.begin(), end);
    }
    std::sort(waiting.begin(), waiting.end());
    out.push_back(waiting);
  }
  return out;
}

}  // namespace footlight::planner
