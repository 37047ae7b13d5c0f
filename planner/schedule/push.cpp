// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/push.hpp"

#include <algorithm>
#include <numeric>

#include "planner/schedule/step_distance.hpp"

namespace footlight::planner {
namespace {

constexpr std::uint32_t kNobody = 0xFFFFFFFFU;
constexpr CellIndex kUndecided{0xFFFFFFFFU};
constexpr double kRounding = 1e-9;
/// Steps for each step of the way across the stage; formations that can be sorted at all are by a fraction of it.
constexpr int kPatience = 8;
/// Times that each may be asked in a step on an average; then nobody steps aside any more.
constexpr std::size_t kMostAsked = 40;

class Pusher {
 public:
  Pusher(const StepsTask& task, Steps& steps)
      : task_(task),
        steps_(steps),
        grid_(task.ways->grid()),
        distance_(*task.ways),
        least_turn_(least_turn(task)),
        at_(steps.last),
        next_(at_.size(), kUndecided),
        waited_(at_.size(), 0),
        order_(at_.size()),
        occupant_(static_cast<std::size_t>(grid_.size()), kNobody),
        taker_(occupant_) {
    for (std::uint32_t i = 0; i < at_.size(); ++i) occupant_[at_[i].at()] = i;
    std::iota(order_.begin(), order_.end(), 0U);
  }

  void run() {
    const int most = kPatience * (grid_.columns() + grid_.rows());
    for (int n = 0; n < most && steps_.count() < task_.most_steps && !all_home(); ++n) step();
    steps_.last = at_;
    steps_.arrived = all_home();
  }

 private:
  [[nodiscard]] CellIndex goal_of(std::uint32_t i) const { return task_.to[steps_.target_of[i]]; }
  [[nodiscard]] bool home(std::uint32_t i) const { return at_[i] == goal_of(i); }
  [[nodiscard]] bool all_home() const {
    return std::all_of(order_.begin(), order_.end(), [&](std::uint32_t i) { return home(i); });
  }
  [[nodiscard]] int steps_to_goal(std::uint32_t i, CellIndex from) { return distance_.steps(from, goal_of(i)); }

  void step() {
    for (std::uint32_t i = 0; i < at_.size(); ++i) {
      exchange_with_neighbours(i);
      waited_[i] = home(i) ? 0 : waited_[i] + 1;
    }
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return waited_[a] > waited_[b]; });
    for (const std::uint32_t i : order_) {
      if (next_[i] == kUndecided) (void)decide(i);
    }
    for (std::uint32_t i = 0; i < at_.size(); ++i) {
      if (next_[i] != at_[i]) steps_.moves.push_back({i, next_[i]});
      taker_[next_[i].at()] = kNobody;
      occupant_[at_[i].at()] = kNobody;
    }
    for (std::uint32_t i = 0; i < at_.size(); ++i) occupant_[next_[i].at()] = i;
    decided_.clear();
    at_ = next_;
    std::fill(next_.begin(), next_.end(), kUndecided);
    steps_.first.push_back(static_cast<std::uint32_t>(steps_.moves.size()));
  }

  /// Somebody of the same kind at her goal, a step nearer to mine, gives it to me for mine.
  void exchange_with_neighbours(std::uint32_t i) {
    if (home(i)) return;
    const int steps = steps_to_goal(i, at_[i]);
    for (const CellIndex cell : grid_.neighbours(at_[i])) {
      const std::uint32_t other = occupant_[cell.at()];
      if (other == kNobody || task_.kind[i] != task_.kind[other] || !home(other)) continue;
      if (steps_to_goal(i, cell) >= steps) continue;
      std::swap(steps_.target_of[i], steps_.target_of[other]);
      return;
    }
  }

  /// PIBT: takes the best cell that can be had, pushing whoever is there. @return false: stays, nothing else was left
  bool decide(std::uint32_t i) {
    decided_.push_back(i);
    std::vector<CellIndex> wishes{at_[i]};
    for (const CellIndex cell : grid_.neighbours(at_[i])) {
      if (distance_.linked(at_[i], cell)) wishes.push_back(cell);
    }
    std::stable_sort(wishes.begin(), wishes.end(), [&](CellIndex a, CellIndex b) {
      const int da = steps_to_goal(i, a);
      const int db = steps_to_goal(i, b);
      return da < db || (da == db && (occupant_[a.at()] == kNobody) > (occupant_[b.at()] == kNobody));
    });
    for (const CellIndex cell : wishes) {
      if (taker_[cell.at()] != kNobody) continue;
      take(i, cell);
      const std::uint32_t other = occupant_[cell.at()];
      if (other == kNobody || other == i) return true;
      const std::size_t before = decided_.size();
      const std::uint32_t counted_on = taker_[at_[i].at()];
      const bool asked = next_[other] == kUndecided;
      const bool leaves = !asked || (decided_.size() < kMostAsked * at_.size() && decide(other));
      if (leaves && next_[other] != cell && may_follow(i, cell, next_[other])) return true;
      // She stays, or leaves by too sharp a turn; where somebody counts on my cell meanwhile, nobody was asked.
      if (taker_[at_[i].at()] != counted_on) forget(before);
      if (taker_[cell.at()] == i) taker_[cell.at()] = kNobody;
    }
    // Whoever has asked for this cell does not get it.
    take(i, at_[i]);
    return false;
  }

  void take(std::uint32_t i, CellIndex cell) {
    next_[i] = cell;
    taker_[cell.at()] = i;
  }
  /// Who was asked since then has not decided.
  void forget(std::size_t before) {
    for (; decided_.size() > before; decided_.pop_back()) {
      const std::uint32_t i = decided_.back();
      if (next_[i] == kUndecided) continue;
      if (taker_[next_[i].at()] == i) taker_[next_[i].at()] = kNobody;
      next_[i] = kUndecided;
    }
  }

  /// Also says no to two people who exchange their cells.
  [[nodiscard]] bool may_follow(std::uint32_t i, CellIndex cell, CellIndex onward) const {
    const Point middle = grid_.centre(cell);
    const double pitch_m = grid_.pitch_m();
    return dot(middle - grid_.centre(at_[i]), grid_.centre(onward) - middle) >=
           (least_turn_ - kRounding) * pitch_m * pitch_m;
  }

  const StepsTask& task_;
  Steps& steps_;
  const Grid& grid_;
  StepDistance distance_;
  double least_turn_;
  std::vector<CellIndex> at_;
  std::vector<CellIndex> next_;
  std::vector<std::uint32_t> waited_;  ///< steps since each was at her goal
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> decided_;   ///< in this step, who was asked later further behind
  std::vector<std::uint32_t> occupant_;  ///< of each cell before the step
  std::vector<std::uint32_t> taker_;     ///< and after it, as far as decided
};

}  // namespace

double least_turn(const StepsTask& task) {
  // p (1 - l) cos(a/2) must be the clearance.
  const double share = task.clearance_m / (task.ways->grid().pitch_m() * (1 - task.late_share));
  return std::max(0.0, 2 * share * share - 1);
}

void push_aside(const StepsTask& task, Steps& steps) {
  const std::size_t cells = static_cast<std::size_t>(task.ways->grid().size());
  if (!task.ways->open() && steps.last.size() > StepDistance::kMostKept / cells) return;
  Pusher(task, steps).run();
}

}  // namespace footlight::planner
