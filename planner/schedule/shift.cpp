// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/shift.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>

namespace footlight::planner {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
/// Cells x steps above which memory would be better spent: about 100 bytes each.
constexpr std::size_t kMostPlaces = 4'000'000;

/// Maximum flow with unit capacities; arc e runs against arc e ^ 1.
class UnitFlow {
 public:
  UnitFlow(std::size_t nodes, std::size_t arcs) : first_(nodes, kNone), level_(nodes), at_(nodes) {
    head_.reserve(2 * arcs);
    next_.reserve(2 * arcs);
    free_.reserve(2 * arcs);
  }
  /// Later arcs of a node are tried before earlier ones.
  void join(std::uint32_t from, std::uint32_t to) {
    add(from, to, 1);
    add(to, from, 0);
  }
  int run(std::uint32_t source, std::uint32_t sink) {
    int flow = 0;
    while (rank(source, sink)) {
      at_ = first_;
      while (send(source, sink)) ++flow;
    }
    return flow;
  }
  /// Where the unit that leaves a node goes.
  [[nodiscard]] std::uint32_t used(std::uint32_t from) const {
    for (std::uint32_t e = first_[from]; e != kNone; e = next_[e]) {
      if (e % 2 == 0 && free_[e] == 0) return head_[e];
    }
    return kNone;
  }

 private:
  void add(std::uint32_t from, std::uint32_t to, char room) {
    head_.push_back(to);
    free_.push_back(room);
    next_.push_back(first_[from]);
    first_[from] = static_cast<std::uint32_t>(head_.size() - 1);
  }
  bool rank(std::uint32_t source, std::uint32_t sink) {
    std::fill(level_.begin(), level_.end(), kNone);
    std::vector<std::uint32_t> queue{source};
    level_[source] = 0;
    for (std::size_t n = 0; n < queue.size() && level_[sink] == kNone; ++n) {
      for (std::uint32_t e = first_[queue[n]]; e != kNone; e = next_[e]) {
        if (free_[e] == 0 || level_[head_[e]] != kNone) continue;
        level_[head_[e]] = level_[queue[n]] + 1;
        queue.push_back(head_[e]);
      }
    }
    return level_[sink] != kNone;
  }
  bool send(std::uint32_t source, std::uint32_t sink) {
    path_.clear();
    std::uint32_t node = source;
    while (node != sink) {
      std::uint32_t& e = at_[node];
      while (e != kNone && (free_[e] == 0 || level_[head_[e]] != level_[node] + 1)) e = next_[e];
      if (e != kNone) {
        path_.push_back(e);
        node = head_[e];
        continue;
      }
      if (path_.empty()) return false;
      level_[node] = kNone;  // a dead end
      node = head_[path_.back() ^ 1U];
      path_.pop_back();
    }
    for (const std::uint32_t e : path_) {
      free_[e] = 0;
      free_[e ^ 1U] = 1;
    }
    return true;
  }

  std::vector<std::uint32_t> first_;
  std::vector<std::uint32_t> level_;
  std::vector<std::uint32_t> at_;
  std::vector<std::uint32_t> head_;
  std::vector<std::uint32_t> next_;
  std::vector<char> free_;
  std::vector<std::uint32_t> path_;
};

class Shifter {
 public:
  explicit Shifter(const ShiftTask& task) : task_(task) {
    const Grid& grid = task.ways->grid();
    std::vector<std::uint32_t> number(static_cast<std::size_t>(grid.size()), kNone);
    for (std::size_t i = 0; i < number.size(); ++i) {
      if (!task.ways->can_stand(CellIndex::of(i))) continue;
      number[i] = static_cast<std::uint32_t>(cells_.size());
      cells_.push_back(CellIndex::of(i));
    }
    near_.resize(cells_.size());
    for (std::uint32_t c = 0; c < cells_.size(); ++c) {
      const Point here = grid.centre(cells_[c]);
      for (const CellIndex next : grid.within(here, 1.1 * grid.pitch_m())) {
        const std::uint32_t n = number[next.at()];
        if (n != kNone && n != c && task.ways->straight(here, grid.centre(next))) near_[c].push_back(n);
      }
    }
    for (const CellIndex cell : task.from) from_.push_back(number[cell.at()]);
    for (const CellIndex cell : task.to) to_.push_back(number[cell.at()]);
    away_ = hops(to_);
    // Who is farther from the places to reach is tried last; staying comes before going back.
    for (std::uint32_t c = 0; c < cells_.size(); ++c) {
      near_[c].push_back(c);
      std::sort(near_[c].begin(), near_[c].end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::tuple(away_[a], a != c, a) > std::tuple(away_[b], b != c, b);
      });
    }
  }

  std::optional<std::vector<std::vector<CellIndex>>> run() const {
    if (std::count(from_.begin(), from_.end(), kNone) + std::count(to_.begin(), to_.end(), kNone) > 0) {
      return std::nullopt;
    }
    const std::vector<std::uint32_t> since = hops(from_);
    std::uint32_t least = 1;
    for (const std::uint32_t c : from_) least = std::max(least, away_[c]);
    for (const std::uint32_t c : to_) least = std::max(least, since[c]);
    const auto most = static_cast<std::uint32_t>(
        std::min<std::size_t>(static_cast<std::size_t>(std::max(0, task_.most_steps)), kMostPlaces / cells_.size()));
    for (std::uint32_t steps = least; steps <= most;) {
      if (auto found = in_steps(steps)) return found;
      if (steps == most) break;
      steps = std::min(most, steps + std::max(2U, steps / 3));
    }
    return std::nullopt;
  }

 private:
  [[nodiscard]] std::vector<std::uint32_t> hops(const std::vector<std::uint32_t>& start) const {
    std::vector<std::uint32_t> away(cells_.size(), kNone);
    std::vector<std::uint32_t> queue;
    for (const std::uint32_t c : start) {
      if (c == kNone) continue;
      away[c] = 0;
      queue.push_back(c);
    }
    for (std::size_t n = 0; n < queue.size(); ++n) {
      for (const std::uint32_t next : near_[queue[n]]) {
        if (away[next] != kNone) continue;
        away[next] = away[queue[n]] + 1;
        queue.push_back(next);
      }
    }
    return away;
  }

  [[nodiscard]] std::optional<std::vector<std::vector<CellIndex>>> in_steps(std::uint32_t steps) const {
    const auto size = static_cast<std::uint32_t>(cells_.size());
    const auto enter = [&](std::uint32_t step, std::uint32_t c) { return 2 * (step * size + c); };
    const std::uint32_t source = enter(steps + 1, 0);
    const std::uint32_t sink = source + 1;
    UnitFlow flow(sink + 1, std::size_t{size} * (steps + 1) * 8);
    for (std::uint32_t step = 0; step <= steps; ++step) {
      for (std::uint32_t c = 0; c < size; ++c) {
        flow.join(enter(step, c), enter(step, c) + 1);
        if (step == steps) continue;
        for (const std::uint32_t next : near_[c]) flow.join(enter(step, c) + 1, enter(step + 1, next));
      }
    }
    for (const std::uint32_t c : from_) flow.join(source, enter(0, c));
    for (const std::uint32_t c : to_) flow.join(enter(steps, c) + 1, sink);
    if (flow.run(source, sink) != static_cast<int>(from_.size())) return std::nullopt;
    std::vector<std::vector<CellIndex>> places(steps + 1);
    for (std::uint32_t c : from_) {
      for (std::uint32_t step = 0; step <= steps; ++step) {
        places[step].push_back(cells_[c]);
        if (step < steps) c = flow.used(enter(step, c) + 1) / 2 - (step + 1) * size;
      }
    }
    return places;
  }

  const ShiftTask& task_;
  std::vector<CellIndex> cells_;                  // that can be stood on
  std::vector<std::vector<std::uint32_t>> near_;  // neighbours and itself, the ones to try first last
  std::vector<std::uint32_t> from_;
  std::vector<std::uint32_t> to_;
  std::vector<std::uint32_t> away_;  // steps to the nearest place to reach
};

}  // namespace

std::optional<std::vector<std::vector<CellIndex>>> shift(const ShiftTask& task) { return Shifter(task).run(); }

}  // namespace footlight::planner
