// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/step.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>

#include "planner/cell_order.hpp"
#include "planner/schedule/steps.hpp"

namespace footlight::planner {
namespace {

/// Rounds in which only one of two people in conflict has to wait.
constexpr int kPatience = 4;
/// Rounds in which those who conflict when they are late are slowed down.
constexpr int kLagPatience = 14;
/// The first of these, in which only one of two people in conflict is slowed down.
constexpr int kGentleRounds = 3;

template <class T>
std::vector<T> taken(std::span<const T> from, const std::vector<std::uint32_t>& order) {
  std::vector<T> out;
  if (from.empty()) return out;
  out.reserve(order.size());
  for (const std::uint32_t slot : order) out.push_back(from[slot]);
  return out;
}

/// A step with its slots in the order of the cells on which they are.
class OrderedStep {
 public:
  explicit OrderedStep(const StepTask& task)
      : task_(task), order_(order_by_cell(task.snap.now, task.snap.ways->grid().size())) {
    now_ = taken(task.snap.now, order_);
    own_ = taken(task.snap.own, order_);
    kind_ = taken(task.kind, order_);
    radius_m_ = taken(task.radius_m, order_);
    if (task.exact) return;
    wanted_ = taken(task.snap.wanted, order_);
    onward_ = taken(task.snap.onward, order_);
    goal_ = taken(task.snap.goal, order_);
  }

  [[nodiscard]] StageKey key(const StageKey& floor) const {
    StageHash hash("step");
    hash.add(floor).add(task_.exact).add(task_.clearance_m).add(task_.snap.longest_m);
    hash.list(now_).list(own_).list(kind_).list(radius_m_).add(task_.walked_s).add(task_.lag_s).add(task_.wait_s);
    if (task_.over_cells) hash.add(task_.over_cells->most).add(task_.over_cells->step_s);
    if (task_.exact) return hash.key();
    hash.add(task_.snap.onward_m).add(goal_.empty() ? 0.0 : task_.snap.goal_m).list(goal_);
    // Most want their own cell, which need not be said twice.
    hash.list(places_on_the_way(wanted_)).list(places_on_the_way(onward_));
    return hash.list(taken(task_.next_own, order_)).key();
  }

  [[nodiscard]] Step run() const {
    if (task_.over_cells) return over_cells();
    Step step;
    if (task_.exact) {
      step.cells = own_;
      step.leg = pair(step.cells, {}, {});
      return step;
    }
    SnapTask snap_task = ordered_snap();
    std::vector<char> hold(now_.size(), 0);
    std::vector<char> slow(now_.size(), 0);
    snap_task.slow_m = slow_m();
    Snap snapping(snap_task);
    std::optional<Step> best;
    for (int round = 0, patience = kLagPatience; patience > 0; ++round) {
      step.cells = snapping.cells(hold, slow);
      step.leg = pair(step.cells, task_.snap.ways->standable(), hold);
      if (!step.leg.to.empty()) step.cells = std::move(step.leg.to);
      step.leg.to.clear();
      if (stopped()) return step;
      if (!step.leg.conflicts.empty()) {
        wait(step, round, hold);
        continue;
      }
      if (step.leg.late_conflicts.empty()) return step;
      --patience;
      slow_down(step, patience >= kLagPatience - kGentleRounds, slow, hold);
      if (!best || step.leg.late_conflicts.size() < best->leg.late_conflicts.size()) best = std::move(step);
    }
    return std::move(*best);
  }

  /// In the task's numbering of the slots.
  [[nodiscard]] Step numbered(const Step& ordered) const {
    Step out = ordered;
    for (std::uint32_t n = 0; n < order_.size(); ++n) {
      out.cells[order_[n]] = ordered.cells[n];
      out.leg.target_of[order_[n]] = order_[ordered.leg.target_of[n]];
    }
    for (std::size_t step = 0; step < ordered.after.size(); ++step) {
      for (std::uint32_t n = 0; n < order_.size(); ++n) out.after[step][order_[n]] = ordered.after[step][n];
    }
    for (std::uint32_t n = 0; n < ordered.leg.timing.size(); ++n) out.leg.timing[order_[n]] = ordered.leg.timing[n];
    for (auto* pairs : {&out.leg.conflicts, &out.leg.late_conflicts}) {
      for (auto& [a, b] : *pairs) {
        a = order_[a];
        b = order_[b];
      }
    }
    return out;
  }

 private:
  /// Of those who do not want their own cell: who, and where to.
  static std::vector<double> places_on_the_way(const std::vector<Wanted>& list) {
    std::vector<double> places;
    for (std::size_t n = 0; n < list.size(); ++n) {
      if (list[n].own) continue;
      places.insert(places.end(), {static_cast<double>(n), list[n].at.x, list[n].at.y});
    }
    return places;
  }

  [[nodiscard]] bool stopped() const { return task_.stop != nullptr && task_.stop->load(std::memory_order_relaxed); }

  [[nodiscard]] SnapTask ordered_snap() const {
    SnapTask snap_task = task_.snap;
    snap_task.now = now_;
    snap_task.own = own_;
    snap_task.wanted = wanted_;
    snap_task.onward = onward_;
    snap_task.goal = goal_;
    return snap_task;
  }

  [[nodiscard]] Step over_cells() const {
    const std::vector<CellIndex> to = task_.exact ? own_ : snap(ordered_snap());
    StepsTask steps_task{task_.snap.ways, now_, to, task_.over_cells->most, kind_, task_.clearance_m, late_step()};
    // An exact formation is reached or refused by how many counts it would take.
    if (task_.exact) steps_task.most_steps = std::numeric_limits<int>::max();
    std::optional<Steps> steps = step_through(steps_task);
    if (steps && task_.exact && steps->count() > task_.over_cells->most && steps_task.late_share > 0) {
      steps_task.late_share = 0;
      std::optional<Steps> closely = step_through(steps_task);
      if (closely->arrived && closely->count() <= task_.over_cells->most) steps = std::move(closely);
    }
    Step step;
    step.cells = to;
    if (!steps) return stay(step);
    step.leg.target_of = steps->target_of;
    std::vector<CellIndex> at(now_);
    for (int n = 0; n < steps->count(); ++n) {
      for (std::uint32_t m = steps->first[std::size_t(n)]; m < steps->first[std::size_t(n) + 1]; ++m) {
        at[steps->moves[m].person] = steps->moves[m].cell;
      }
      step.after.push_back(at);
    }
    if (task_.exact && !steps->arrived) step.after.push_back(to_of(step));
    if (!task_.exact) {
      for (std::size_t i = 0; i < at.size(); ++i) step.cells[step.leg.target_of[i]] = at[i];
    }
    return step;
  }

  /// Where everybody ends, by where she began.
  [[nodiscard]] std::vector<CellIndex> to_of(const Step& step) const {
    std::vector<CellIndex> to;
    to.reserve(now_.size());
    for (const std::uint32_t target : step.leg.target_of) to.push_back(step.cells[target]);
    return to;
  }

  /// Nobody can come to where she shall over cells: to an exact formation it is shown what is missing, else all stay.
  [[nodiscard]] Step stay(Step step) const {
    step.leg.target_of.resize(now_.size());
    std::iota(step.leg.target_of.begin(), step.leg.target_of.end(), 0U);
    if (task_.exact) {
      step.after.push_back(step.cells);
    } else {
      step.cells = now_;
    }
    return step;
  }

  /// Lateness as a share of a step; more than nearly one can be kept by nobody.
  [[nodiscard]] double late_step() const { return std::min(0.99, task_.lag_s / task_.over_cells->step_s); }

  [[nodiscard]] Leg pair(const std::vector<CellIndex>& to, std::span<const char> free,
                         std::span<const char> hold) const {
    LegTask leg;
    leg.ways = task_.snap.ways;
    leg.from = now_;
    leg.to = to;
    leg.longest_m = task_.snap.longest_m;
    leg.clearance_m = task_.clearance_m;
    leg.kind = kind_;
    leg.radius_m = radius_m_;
    leg.late_share = task_.walked_s > 0 ? std::min(1.0, task_.lag_s / task_.walked_s) : 0;
    leg.stagger_share = task_.walked_s > 0 ? task_.wait_s / task_.walked_s : 0;
    leg.free = free;
    leg.fixed_target = hold;
    leg.stop = task_.stop;
    return settle(leg);
  }

  /// Somebody on a walk of this length comes by lateness no nearer to others than the bound allows.
  [[nodiscard]] double slow_m() const {
    const double spare_m = task_.snap.ways->grid().clearance_bound_m() - task_.clearance_m;
    return task_.lag_s > 0 ? std::max(0.0, spare_m) * task_.walked_s / task_.lag_s : task_.snap.longest_m;
  }

  /// Of each pair the one with the shorter walk (later both) goes slowly, or waits when that was not enough.
  void slow_down(const Step& step, bool one, std::vector<char>& slow, std::vector<char>& hold) const {
    for (const auto& [a, b] : step.leg.late_conflicts) {
      const bool a_first = walk_m(step, a) <= walk_m(step, b);
      for (const std::uint32_t slot : {a_first ? a : b, a_first ? b : a}) {
        (slow[slot] == 0 ? slow : hold)[slot] = 1;
        if (one) break;
      }
    }
  }

  void wait(const Step& step, int round, std::vector<char>& hold) const {
    bool added = false;
    for (const auto& [a, b] : step.leg.conflicts) {
      // The one with the shorter walk waits; after a few rounds both do.
      const bool a_waits = walk_m(step, a) <= walk_m(step, b);
      for (const std::uint32_t slot : {a_waits ? a : b, a_waits ? b : a}) {
        if (hold[slot] != 0) continue;
        hold[slot] = 1;
        added = true;
        if (round < kPatience) break;
      }
    }
    if (!added) std::fill(hold.begin(), hold.end(), char{1});
  }

  [[nodiscard]] double walk_m(const Step& step, std::uint32_t slot) const {
    const Grid& grid = task_.snap.ways->grid();
    return distance(grid.centre(now_[slot]), grid.centre(step.cells[step.leg.target_of[slot]]));
  }

  const StepTask& task_;
  std::vector<std::uint32_t> order_;
  std::vector<CellIndex> now_;
  std::vector<CellIndex> own_;
  std::vector<CellIndex> goal_;
  std::vector<Wanted> wanted_;
  std::vector<Wanted> onward_;
  std::vector<std::uint32_t> kind_;
  std::vector<double> radius_m_;
};

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

std::vector<std::uint32_t> flat(const Pairs& pairs) {
  std::vector<std::uint32_t> out;
  for (const auto& [a, b] : pairs) {
    out.push_back(a);
    out.push_back(b);
  }
  return out;
}

Pairs pairs_of(const std::vector<std::uint32_t>& flat) {
  Pairs out;
  for (std::size_t n = 0; n + 1 < flat.size(); n += 2) out.emplace_back(flat[n], flat[n + 1]);
  return out;
}

std::string encoded(const Step& step) {
  StageWriter out;
  std::vector<double> timing;
  for (const Leg::Timing& own : step.leg.timing) {
    timing.push_back(own.start);
    timing.push_back(own.end);
  }
  out.list(step.cells).list(step.leg.target_of).list(flat(step.leg.conflicts)).list(flat(step.leg.late_conflicts));
  out.list(timing).add(step.after.size());
  for (const auto& cells : step.after) out.list(cells);
  return out.add(step.leg.exchanges).add(step.leg.walkable).take();
}

Step decoded(StageReader& reader) {
  Step step;
  step.cells = reader.list<CellIndex>();
  step.leg.target_of = reader.list<std::uint32_t>();
  step.leg.conflicts = pairs_of(reader.list<std::uint32_t>());
  step.leg.late_conflicts = pairs_of(reader.list<std::uint32_t>());
  const auto timing = reader.list<double>();
  for (std::size_t n = 0; n + 1 < timing.size(); n += 2) step.leg.timing.push_back({timing[n], timing[n + 1]});
  for (auto left = reader.get<std::size_t>(); left > 0 && !reader.failed(); --left) {
    step.after.push_back(reader.list<CellIndex>());
  }
  step.leg.exchanges = reader.get<int>();
  step.leg.walkable = reader.get<bool>();
  return step;
}

}  // namespace

Step walk_step(const StepTask& task) {
  const OrderedStep step(task);
  return step.numbered(step.run());
}

Step walk_step(const StepTask& task, const StageKey& floor, Stages* stages, StageCount* count) {
  const OrderedStep step(task);
  if (stages == nullptr && count == nullptr) return step.numbered(step.run());
  const auto make = [&] { return step.run(); };
  return step.numbered(recall(stages, step.key(floor), count, decoded, encoded, make, task.stop));
}

}  // namespace footlight::planner
