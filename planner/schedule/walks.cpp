// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/walks.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>

#include "planner/assignment/assignment.hpp"
#include "planner/repair/closest_approach.hpp"
#include "planner/repair/exchange.hpp"

namespace footlight::planner {
namespace {

constexpr double kRounding_m = 1e-9;
constexpr int kRounds = 12;
/// How far from her present target somebody may be sent to solve a conflict, pitches.
constexpr double kDetour = 3.2;
/// Above this number of allowed pairs a blocked stage is not matched exactly at once.
constexpr std::size_t kMostArcs = 4'000'000;

class Settler {
 public:
  explicit Settler(const LegTask& task) : task_(task), grid_(task.ways->grid()) {
    for (const CellIndex cell : task.from) sources_.push_back(grid_.centre(cell));
    for (const CellIndex cell : task.to) targets_.push_back(grid_.centre(cell));
    reach_m_ = std::max(task.clearance_m, grid_.clearance_bound_m());
  }

  Leg run() {
    Leg leg;
    leg.target_of.resize(sources_.size());
    std::iota(leg.target_of.begin(), leg.target_of.end(), 0U);
    if (!walkable(leg.target_of)) {
      if (auto exact = match_walkable()) leg.target_of = std::move(*exact);
    }
    leg.walkable = walkable(leg.target_of);
    leg.exchanges = swap_conflicts(leg.target_of);
    auto close = close_pairs(leg.target_of);
    if (!close.empty()) resolve(leg, std::move(close));
    return leg;
  }

  [[nodiscard]] std::vector<NearPair> close_pairs(const std::vector<std::uint32_t>& target_of) const {
    std::vector<Walk> walks(sources_.size());
    for (std::size_t i = 0; i < walks.size(); ++i) walks[i] = {sources_[i], targets_[target_of[i]]};
    return near_pairs(walks, task_.clearance_m - kRounding_m);
  }

 private:
  [[nodiscard]] bool may_walk(Point from, Point to) const {
    return distance(from, to) <= task_.longest_m && task_.ways->straight(from, to);
  }
  [[nodiscard]] bool walkable(const std::vector<std::uint32_t>& target_of) const {
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      if (!may_walk(sources_[i], targets_[target_of[i]])) return false;
    }
    return true;
  }
  int swap_conflicts(std::vector<std::uint32_t>& target_of) const {
    return exchange(sources_, targets_, target_of, reach_m_, [&](Point a, Point b) { return may_walk(a, b); })
        .exchanges;
  }

  /// The exact pairing under the limits; nothing when there is none (or the stage is blocked and too large to try).
  [[nodiscard]] std::optional<std::vector<std::uint32_t>> match_walkable() const {
    if (task_.ways->open()) {
      auto best = assign(sources_, targets_, WalkCost::squared, task_.longest_m);
      if (!best) return std::nullopt;
      return std::move(best->target_of);
    }
    std::vector<Arc> arcs;
    for (std::uint32_t i = 0; i < sources_.size(); ++i) {
      for (std::uint32_t j = 0; j < targets_.size(); ++j) {
        if (may_walk(sources_[i], targets_[j])) arcs.push_back({i, j, squared_length(sources_[i] - targets_[j])});
      }
      if (arcs.size() > kMostArcs) return std::nullopt;
    }
    auto best = assign_sparse(static_cast<std::uint32_t>(sources_.size()), arcs);
    if (!best) return std::nullopt;
    return std::move(best->target_of);
  }

  /// Allowed pairs around the present ones.
  [[nodiscard]] std::vector<Arc> arcs_around(const std::vector<std::uint32_t>& target_of) const {
    std::vector<std::uint32_t> at_cell(static_cast<std::size_t>(grid_.size()), kNone);
    for (std::uint32_t j = 0; j < targets_.size(); ++j) at_cell[task_.to[j].at()] = j;
    std::vector<Arc> arcs;
    for (std::uint32_t i = 0; i < sources_.size(); ++i) {
      const std::size_t first = arcs.size();
      for (const CellIndex cell : grid_.within(targets_[target_of[i]], kDetour * grid_.pitch_m())) {
        const std::uint32_t j = at_cell[cell.at()];
        if (j == kNone || (j != target_of[i] && !may_walk(sources_[i], targets_[j]))) continue;
        arcs.push_back({i, j, squared_length(sources_[i] - targets_[j])});
      }
      std::sort(arcs.begin() + static_cast<std::ptrdiff_t>(first), arcs.end(),
                [](const Arc& a, const Arc& b) { return a.target < b.target; });
    }
    return arcs;
  }

  void resolve(Leg& leg, std::vector<NearPair> close) const {
    std::map<std::pair<std::uint32_t, std::uint32_t>, double> penalty;
    std::vector<std::uint32_t> trial = leg.target_of;
    name_conflicts(leg, close);
    const double toll = 2 * grid_.pitch_m() * grid_.pitch_m();
    for (int round = 0; round < kRounds && !leg.conflicts.empty(); ++round) {
      for (const NearPair& pair : close) {
        penalty[{pair.a, trial[pair.a]}] += toll;
        penalty[{pair.b, trial[pair.b]}] += toll;
      }
      std::vector<Arc> arcs = arcs_around(trial);
      for (Arc& arc : arcs) {
        const auto found = penalty.find({arc.source, arc.target});
        if (found != penalty.end()) arc.cost += found->second;
      }
      auto best = assign_sparse(static_cast<std::uint32_t>(sources_.size()), arcs);
      if (!best) return;
      trial = std::move(best->target_of);
      const int exchanged = swap_conflicts(trial);
      close = close_pairs(trial);
      if (close.size() >= leg.conflicts.size()) continue;
      name_conflicts(leg, close);
      leg.target_of = trial;
      leg.exchanges += exchanged;
    }
  }

  static void name_conflicts(Leg& leg, const std::vector<NearPair>& close) {
    leg.conflicts.clear();
    for (const NearPair& pair : close) leg.conflicts.emplace_back(pair.a, pair.b);
  }

  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;
  const LegTask& task_;
  const Grid& grid_;
  std::vector<Point> sources_;
  std::vector<Point> targets_;
  double reach_m_ = 0;
};

}  // namespace

Leg settle(const LegTask& task) { return Settler(task).run(); }

}  // namespace footlight::planner
