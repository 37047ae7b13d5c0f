// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/step.hpp"

#include <algorithm>
#include <numeric>

namespace footlight::planner {
namespace {

/// Rounds in which only one of two people in conflict has to wait.
constexpr int kPatience = 4;

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
  explicit OrderedStep(const StepTask& task) : task_(task), order_(task.snap.now.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
    std::sort(order_.begin(), order_.end(),
              [&](std::uint32_t a, std::uint32_t b) { return task.snap.now[a] < task.snap.now[b]; });
    now_ = taken(task.snap.now, order_);
    own_ = taken(task.snap.own, order_);
    kind_ = taken(task.kind, order_);
    if (task.exact) return;
    wanted_ = taken(task.snap.wanted, order_);
    onward_ = taken(task.snap.onward, order_);
    goal_ = taken(task.snap.goal, order_);
  }

  [[nodiscard]] StageKey key(const StageKey& floor) const {
    StageHash hash("step");
    hash.add(floor).add(task_.exact).add(task_.clearance_m).add(task_.snap.longest_m);
    hash.list(now_).list(own_).list(kind_);
    if (task_.exact) return hash.key();
    hash.add(task_.snap.onward_m).add(goal_.empty() ? 0.0 : task_.snap.goal_m).list(goal_);
    for (const std::vector<Wanted>* list : {&wanted_, &onward_}) {
      std::vector<double> places;
      places.reserve(3 * list->size());
      for (const Wanted& one : *list) {
        places.push_back(one.at.x);
        places.push_back(one.at.y);
        places.push_back(one.own ? 1 : 0);
      }
      hash.list(places);
    }
    return hash.key();
  }

  [[nodiscard]] Step run() const {
    Step step;
    if (task_.exact) {
      step.cells = own_;
      step.leg = pair(step.cells);
      return step;
    }
    SnapTask snap_task = task_.snap;
    snap_task.now = now_;
    snap_task.own = own_;
    snap_task.wanted = wanted_;
    snap_task.onward = onward_;
    snap_task.goal = goal_;
    std::vector<char> hold(now_.size(), 0);
    for (int round = 0;; ++round) {
      snap_task.hold = hold;
      step.cells = snap(snap_task);
      step.leg = pair(step.cells);
      if (step.leg.conflicts.empty()) return step;
      wait(step, round, hold);
    }
  }

  /// In the task's numbering of the slots.
  [[nodiscard]] Step numbered(const Step& ordered) const {
    Step out = ordered;
    for (std::uint32_t n = 0; n < order_.size(); ++n) {
      out.cells[order_[n]] = ordered.cells[n];
      out.leg.target_of[order_[n]] = order_[ordered.leg.target_of[n]];
    }
    for (auto& [a, b] : out.leg.conflicts) {
      a = order_[a];
      b = order_[b];
    }
    return out;
  }

 private:
  [[nodiscard]] Leg pair(const std::vector<CellIndex>& to) const {
    LegTask leg;
    leg.ways = task_.snap.ways;
    leg.from = now_;
    leg.to = to;
    leg.longest_m = task_.snap.longest_m;
    leg.clearance_m = task_.clearance_m;
    leg.kind = kind_;
    return settle(leg);
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
};

std::string encoded(const Step& step) {
  StageWriter out;
  std::vector<std::uint32_t> conflicts;
  for (const auto& [a, b] : step.leg.conflicts) {
    conflicts.push_back(a);
    conflicts.push_back(b);
  }
  out.list(step.cells).list(step.leg.target_of).list(conflicts);
  return out.add(step.leg.exchanges).add(step.leg.walkable).take();
}

Step decoded(StageReader& reader) {
  Step step;
  step.cells = reader.list<CellIndex>();
  step.leg.target_of = reader.list<std::uint32_t>();
  const auto conflicts = reader.list<std::uint32_t>();
  for (std::size_t n = 0; n + 1 < conflicts.size(); n += 2) {
    step.leg.conflicts.emplace_back(conflicts[n], conflicts[n + 1]);
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
  return step.numbered(recall(stages, step.key(floor), count, decoded, encoded, [&] { return step.run(); }));
}

}  // namespace footlight::planner
