// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/walks.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>

#include "core/check.hpp"
#include "planner/assignment/assignment.hpp"
#include "planner/repair/closest_approach.hpp"
#include "planner/repair/exchange.hpp"
#include "planner/repair/room.hpp"
#include "planner/repair/tolerance.hpp"

namespace footlight::planner {
namespace {

constexpr double kRounding_m = 1e-9;
constexpr int kRounds = 6;
/// Who passes within so many pitches of a conflict takes part in solving it.
constexpr double kNeighbourhood = 4;
/// How far from her present target somebody may be sent to solve a conflict, pitches.
constexpr double kDetour = 3.2;
/// Above this number of allowed pairs a blocked stage is not matched exactly at once.
constexpr std::size_t kMostArcs = 4'000'000;

class Settler {
 public:
  explicit Settler(const LegTask& task)
      : task_(task), grid_(task.ways->grid()), room_(task.clearance_m, task.radius_m, grid_.pitch_m()) {
    for (const CellIndex cell : task.from) sources_.push_back(grid_.centre(cell));
    cells_.assign(task.to.begin(), task.to.end());
    for (const CellIndex cell : cells_) targets_.push_back(grid_.centre(cell));
    FL_CHECK(sources_.size() == targets_.size() && (task.kind.empty() || task.kind.size() == sources_.size()));
    reach_m_ = std::max(room_.widest_m(), grid_.clearance_bound_m());
  }

  Leg run() {
    Leg leg;
    leg.target_of.resize(sources_.size());
    std::iota(leg.target_of.begin(), leg.target_of.end(), 0U);
    match_walkable(leg.target_of);
    leg.walkable = walkable(leg.target_of);
    if (stopped()) return leg;
    leg.exchanges = swap_conflicts(leg.target_of);
    loosen(leg);
    if (!leg.conflicts.empty() && !stopped()) {
      resolve(leg, close_pairs(leg.target_of));
      loosen(leg);
    }
    if (!std::equal(cells_.begin(), cells_.end(), task_.to.begin())) leg.to = std::move(cells_);
    return leg;
  }

  [[nodiscard]] std::vector<NearPair> close_pairs(const std::vector<std::uint32_t>& target_of) const {
    std::vector<Walk> walks(sources_.size());
    for (std::size_t i = 0; i < walks.size(); ++i) walks[i] = {sources_[i], targets_[target_of[i]]};
    std::vector<NearPair> close = near_pairs(walks, room_.widest_m() - kRounding_m);
    std::erase_if(close, [&](const NearPair& pair) {
      return pair.approach.distance_m >= room_.between_m(pair.a, pair.b) - kRounding_m;
    });
    return close;
  }

 private:
  [[nodiscard]] bool stopped() const { return task_.stop != nullptr && task_.stop->load(std::memory_order_relaxed); }
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
    return exchange(
               sources_, targets_, target_of, reach_m_, [&](Point a, Point b) { return may_walk(a, b); }, task_.kind)
        .exchanges;
  }

  [[nodiscard]] bool same_kind(std::uint32_t i, std::uint32_t j) const {
    return task_.kind.empty() || task_.kind[i] == task_.kind[j];
  }

  /// Puts the exact pairing under the limits in place of those kinds' in which somebody cannot walk to the target,
  /// where there is one (and the stage is open, or small enough to try). `target_of` is each person's own.
  void match_walkable(std::vector<std::uint32_t>& target_of) const {
    std::map<std::uint32_t, std::vector<std::uint32_t>> unwalkable;
    for (std::uint32_t i = 0; i < sources_.size(); ++i) {
      if (!may_walk(sources_[i], targets_[i])) unwalkable[task_.kind.empty() ? 0 : task_.kind[i]];
    }
    if (unwalkable.empty()) return;
    for (std::uint32_t i = 0; i < sources_.size(); ++i) {
      const auto found = unwalkable.find(task_.kind.empty() ? 0 : task_.kind[i]);
      if (found != unwalkable.end()) found->second.push_back(i);
    }
    for (const auto& [kind, people] : unwalkable) {
      const auto best = match_within(people);
      for (std::size_t n = 0; best && n < people.size(); ++n) target_of[people[n]] = people[best->target_of[n]];
    }
  }

  /// Small changes so that people may be late; they solve most conflicts of punctual people, too.
  void loosen(Leg& leg) {
    const MayWalk may = [&](Point a, Point b) { return may_walk(a, b); };
    ToleranceTask task{&grid_, task_.from, task_.kind, task_.clearance_m, task_.late_share, &may, task_.longest_m};
    task.stagger_share = task_.stagger_share;
    task.free = task_.free;
    task.radius_m = task_.radius_m;
    task.fixed_target = task_.fixed_target;
    task.stop = task_.stop;
    const Tolerance found = keep_apart_when_late(task, cells_, leg.target_of);
    leg.exchanges += found.exchanges;
    for (std::size_t j = 0; j < targets_.size() && found.moved > 0; ++j) targets_[j] = grid_.centre(cells_[j]);
    leg.timing.clear();
    for (std::size_t i = 0; i < found.walks.size() && found.waits > 0; ++i) {
      leg.timing.push_back({found.walks[i].start, found.walks[i].end});
    }
    leg.conflicts.clear();
    leg.late_conflicts.clear();
    for (const auto& [a, b] : found.left) {
      const double least_m = room_.between_m(a, b) - kRounding_m;
      const bool punctual = least_squared_when_late_m2(found.walks[a], found.walks[b], 0) < least_m * least_m;
      (punctual ? leg.conflicts : leg.late_conflicts).emplace_back(a, b);
    }
  }

  /// The exact pairing of some people with their own targets; nothing when there is none.
  [[nodiscard]] std::optional<Assignment> match_within(const std::vector<std::uint32_t>& people) const {
    if (task_.ways->open()) {
      std::vector<Point> starts;
      std::vector<Point> goals;
      for (const std::uint32_t i : people) {
        starts.push_back(sources_[i]);
        goals.push_back(targets_[i]);
      }
      return assign(starts, goals, WalkCost::squared, task_.longest_m, task_.stop);
    }
    std::vector<Arc> arcs;
    for (std::uint32_t n = 0; n < people.size(); ++n) {
      const Point from = sources_[people[n]];
      for (std::uint32_t m = 0; m < people.size(); ++m) {
        const Point to = targets_[people[m]];
        if (may_walk(from, to)) arcs.push_back({n, m, squared_length(from - to)});
      }
      if (arcs.size() > kMostArcs) return std::nullopt;
    }
    return assign_sparse(static_cast<std::uint32_t>(people.size()), arcs);
  }

  /// People whose walks pass near a conflict, ascending: they may be matched again among themselves.
  [[nodiscard]] std::vector<std::uint32_t> people_near(const std::vector<NearPair>& close,
                                                       const std::vector<std::uint32_t>& target_of) const {
    std::vector<char> marked(static_cast<std::size_t>(grid_.size()), 0);
    const auto mark = [&](CellIndex cell) {
      for (const CellIndex near : grid_.within(grid_.centre(cell), kNeighbourhood * grid_.pitch_m())) {
        marked[near.at()] = 1;
      }
    };
    for (const NearPair& pair : close) {
      for (const std::uint32_t i : {pair.a, pair.b}) {
        mark(task_.from[i]);
        mark(cells_[target_of[i]]);
      }
    }
    std::vector<std::uint32_t> people;
    for (std::uint32_t i = 0; i < sources_.size(); ++i) {
      if (marked[task_.from[i].at()] != 0 || marked[cells_[target_of[i]].at()] != 0) people.push_back(i);
    }
    return people;
  }

  using Penalties = std::map<std::pair<std::uint32_t, std::uint32_t>, double>;

  /// Matches `people` to their own targets anew, each among the targets around her present one.
  void match_again(const std::vector<std::uint32_t>& people, const Penalties& penalties,
                   std::vector<std::uint32_t>& target_of) const {
    std::vector<std::uint32_t> at_cell(static_cast<std::size_t>(grid_.size()), kNone);
    for (std::uint32_t n = 0; n < people.size(); ++n) at_cell[cells_[target_of[people[n]]].at()] = n;
    std::vector<Arc> arcs;
    for (std::uint32_t n = 0; n < people.size(); ++n) {
      const std::uint32_t i = people[n];
      const std::size_t first = arcs.size();
      for (const CellIndex cell : grid_.within(targets_[target_of[i]], kDetour * grid_.pitch_m())) {
        const std::uint32_t m = at_cell[cell.at()];
        if (m == kNone) continue;
        const std::uint32_t j = target_of[people[m]];
        if (m != n && (!same_kind(i, j) || !may_walk(sources_[i], targets_[j]))) continue;
        const auto penalty = penalties.find({i, j});
        const double toll = penalty == penalties.end() ? 0 : penalty->second;
        arcs.push_back({n, m, squared_length(sources_[i] - targets_[j]) + toll});
      }
      std::sort(arcs.begin() + static_cast<std::ptrdiff_t>(first), arcs.end(),
                [](const Arc& a, const Arc& b) { return a.target < b.target; });
    }
    const auto best = assign_sparse(static_cast<std::uint32_t>(people.size()), arcs);
    if (!best) return;
    std::vector<std::uint32_t> targets;
    targets.reserve(people.size());
    for (const std::uint32_t i : people) targets.push_back(target_of[i]);
    for (std::size_t n = 0; n < people.size(); ++n) target_of[people[n]] = targets[best->target_of[n]];
  }

  void resolve(Leg& leg, std::vector<NearPair> close) const {
    Penalties penalties;
    std::vector<std::uint32_t> trial = leg.target_of;
    name_conflicts(leg, close);
    const double toll = 2 * grid_.pitch_m() * grid_.pitch_m();
    for (int round = 0; round < kRounds && !leg.conflicts.empty() && !stopped(); ++round) {
      for (const NearPair& pair : close) {
        penalties[{pair.a, trial[pair.a]}] += toll;
        penalties[{pair.b, trial[pair.b]}] += toll;
      }
      match_again(people_near(close, trial), penalties, trial);
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
  Room room_;
  std::vector<Point> sources_;
  std::vector<CellIndex> cells_;  ///< the targets
  std::vector<Point> targets_;    ///< their centres
  double reach_m_ = 0;
};

}  // namespace

Leg settle(const LegTask& task) { return Settler(task).run(); }

}  // namespace footlight::planner
