// SPDX-License-Identifier: Apache-2.0
#include "planner/joint/time_flow.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>

#include "core/check.hpp"

namespace footlight::planner {
namespace {

constexpr std::int32_t kFar = std::numeric_limits<std::int32_t>::max() / 2;
constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();

/// Searches look at so many states for each node before the potentials are made exact again.
constexpr std::size_t kPatience = 2;

/// Every node (a cell at an instant) has a way in and a way out, 2 n and 2 n + 1, and one place between them.
class FlowSearch {
 public:
  explicit FlowSearch(const FlowTask& task)
      : task_(task),
        cells_(static_cast<std::uint32_t>(task.cells)),
        last_(static_cast<std::uint32_t>(task.intervals.size())),
        potential_(2 * nodes(), 0),
        distance_(2 * nodes(), kFar),
        parent_(2 * nodes(), kNobody),
        before_(nodes(), kNobody),
        after_(nodes(), kNobody),
        cost_in_(nodes(), 0) {
    look_back();
  }

  std::optional<TimeFlow> run(const Progress& progress) {
    for (std::size_t i = 0; i < task_.start.size(); ++i) {
      if (i % 64 == 0) {
        if (progress.stopped()) return std::nullopt;
        progress.tell("joint", static_cast<double>(i) / static_cast<double>(task_.start.size()));
      }
      if (looked_at_ > kPatience * nodes()) look_back_again();
      route(task_.start[i].value());
    }
    return result();
  }

 private:
  [[nodiscard]] std::size_t nodes() const { return static_cast<std::size_t>(cells_) * (last_ + 1); }
  [[nodiscard]] bool used(std::uint32_t node) const { return before_[node] != kNobody || after_[node] != kNobody; }

  /// Potential of a node: less the cost from there to the end.
  void look_back() {
    const std::uint32_t top = last_ * cells_;
    for (std::uint32_t c = 0; c < cells_; ++c) set_potential(top + c, -task_.end_cost[c]);
    for (std::uint32_t k = last_; k-- > 0;) {
      const FlowInterval& interval = task_.intervals[k];
      for (std::uint32_t c = 0; c < cells_; ++c) {
        std::int32_t best = kFar;
        for (std::uint32_t a = interval.reach->first[c]; a < interval.reach->first[c + 1]; ++a) {
          best = std::min(best, interval.cost[a] - potential_[2 * ((k + 1) * cells_ + interval.reach->to[a])]);
        }
        set_potential(k * cells_ + c, best == kFar ? 0 : -best);
      }
    }
  }
  void set_potential(std::uint32_t node, std::int32_t value) {
    potential_[2 * node] = potential_[2 * node + 1] = value;
  }

  void reach(std::uint32_t state, std::int32_t distance, std::uint32_t from) {
    if (distance >= distance_[state] || distance >= end_distance_) return;
    if (distance_[state] == kFar) touched_.push_back(state);
    distance_[state] = distance;
    parent_[state] = from;
    // Among equals the later instant first: straight to the end.
    push(state, distance);
  }

  void look_around(std::uint32_t state, std::int32_t distance) {
    const std::uint32_t node = state / 2;
    const std::int32_t here = distance + potential_[state];
    if (state % 2 == 0) {
      if (!used(node)) return reach(state + 1, here - potential_[state + 1], state);
      const std::uint32_t before = before_[node];
      if (before != kNobody) reach(2 * before + 1, here - cost_in_[node] - potential_[2 * before + 1], state);
      return;
    }
    if (before_[node] != kNobody) reach(state - 1, here - potential_[state - 1], state);
    const std::uint32_t k = node / cells_;
    if (k == last_) {
      if (used(node)) return;
      const std::int32_t total = here + task_.end_cost[node % cells_] - end_potential_;
      if (total < end_distance_) {
        end_distance_ = total;
        end_state_ = state;
      }
      return;
    }
    const FlowInterval& interval = task_.intervals[k];
    const std::uint32_t next = (k + 1) * cells_;
    const std::uint32_t end = interval.reach->first[node % cells_ + 1];
    for (std::uint32_t a = interval.reach->first[node % cells_]; a < end; ++a) {
      const std::uint32_t to = next + interval.reach->to[a];
      reach(2 * to, here + interval.cost[a] - potential_[2 * to], state);
    }
  }

  void push(std::uint32_t state, std::int32_t distance) {
    open_.push_back((static_cast<std::uint64_t>(distance) << 32U) | (0xFFFFFFFFU - state));
    std::push_heap(open_.begin(), open_.end(), std::greater<>());
  }
  std::pair<std::uint32_t, std::int32_t> pop() {
    const std::uint64_t top = open_.front();
    std::pop_heap(open_.begin(), open_.end(), std::greater<>());
    open_.pop_back();
    ++looked_at_;
    return {0xFFFFFFFFU - static_cast<std::uint32_t>(top & 0xFFFFFFFFU), static_cast<std::int32_t>(top >> 32U)};
  }

  /// Searches leave potentials that hold but no longer lead straight to the end. This makes them exact again: what
  /// everybody would still lose on the way from each state, by one search backwards from the end.
  void look_back_again() {
    const auto lower = [&](std::uint32_t state, std::int32_t distance) {
      if (distance >= distance_[state]) return;
      distance_[state] = distance;
      push(state, distance);
    };
    const std::uint32_t top = last_ * cells_;
    for (std::uint32_t c = 0; c < cells_; ++c) {
      const std::uint32_t state = 2 * (top + c) + 1;
      if (!used(top + c)) lower(state, task_.end_cost[c] + potential_[state] - end_potential_);
    }
    std::int32_t farthest = 0;
    while (!open_.empty()) {
      const auto [state, distance] = pop();
      if (distance != distance_[state]) continue;
      farthest = distance;
      const std::uint32_t node = state / 2;
      const std::int32_t here = distance - potential_[state];
      if (state % 2 == 1) {
        if (!used(node)) lower(state - 1, here + potential_[state - 1]);
        const std::uint32_t after = after_[node];
        if (after != kNobody) lower(2 * after, here - cost_in_[after] + potential_[2 * after]);
        continue;
      }
      if (before_[node] != kNobody) lower(state + 1, here + potential_[state + 1]);
      const std::uint32_t k = node / cells_;
      if (k == 0) continue;
      const FlowInterval& interval = task_.intervals[k - 1];
      const std::uint32_t end = interval.reach->first[node % cells_ + 1];
      for (std::uint32_t a = interval.reach->first[node % cells_]; a < end; ++a) {
        const std::uint32_t from = 2 * ((k - 1) * cells_ + interval.reach->to[a]) + 1;
        lower(from, here + interval.cost[interval.reach->back[a]] + potential_[from]);
      }
    }
    for (std::size_t state = 0; state < distance_.size(); ++state) {
      potential_[state] -= std::min(distance_[state], farthest);
      distance_[state] = kFar;
    }
    looked_at_ = 0;
  }

  void route(std::uint32_t start) {
    end_distance_ = kFar;
    FL_CHECK(!used(start) || before_[start] == kNobody);
    reach(2 * start + 1, 0, kNobody);
    while (!open_.empty()) {
      const auto [state, distance] = pop();
      if (distance >= end_distance_) break;
      if (distance == distance_[state]) look_around(state, distance);
    }
    FL_CHECK(end_distance_ < kFar);
    open_.clear();
    for (const std::uint32_t state : touched_) {
      potential_[state] += std::min(distance_[state], end_distance_) - end_distance_;
      distance_[state] = kFar;
    }
    touched_.clear();
    walk_back();
  }

  void walk_back() {
    std::uint32_t state = end_state_;
    while (parent_[state] != kNobody) {
      const std::uint32_t from = parent_[state];
      const std::uint32_t node = state / 2;
      if (state % 2 == 0 && from / 2 == node) {
        before_[node] = after_[node] = kNobody;  // whoever was here goes elsewhere
      } else if (state % 2 == 0) {
        before_[node] = from / 2;
        cost_in_[node] = cost_of(from / 2, node);
        after_[from / 2] = node;
      }
      state = from;
    }
  }

  [[nodiscard]] std::int32_t cost_of(std::uint32_t from, std::uint32_t to) const {
    const FlowInterval& interval = task_.intervals[from / cells_];
    const auto begin = interval.reach->to.begin() + interval.reach->first[from % cells_];
    const auto end = interval.reach->to.begin() + interval.reach->first[from % cells_ + 1];
    const auto found = std::lower_bound(begin, end, to % cells_);
    return interval.cost[static_cast<std::size_t>(found - interval.reach->to.begin())];
  }

  [[nodiscard]] TimeFlow result() const {
    TimeFlow out;
    out.at.resize(last_ + 1, std::vector<CellIndex>(task_.start.size()));
    for (std::size_t i = 0; i < task_.start.size(); ++i) {
      std::uint32_t node = task_.start[i].value();
      for (std::uint32_t k = 0; k <= last_; ++k) {
        out.at[k][i] = CellIndex(node % cells_);
        if (k == last_) break;
        FL_CHECK(after_[node] != kNobody);
        node = after_[node];
        out.cost += cost_in_[node];
      }
      out.cost += task_.end_cost[node % cells_];
    }
    out.gap = out.cost - bound();
    return out;
  }

  /// Value of the dual solution: what the potentials promise for each start, less what full nodes charge.
  [[nodiscard]] std::int64_t bound() const {
    std::int64_t value = 0;
    for (const CellIndex cell : task_.start) value += end_potential_ - potential_[2 * cell.at() + 1];
    for (std::uint32_t node = cells_; node < nodes(); ++node) {
      value -= std::max(0, potential_[2 * node + 1] - potential_[2 * node]);
    }
    for (std::uint32_t c = 0; c < cells_; ++c) {
      const std::int32_t out = potential_[2 * (last_ * cells_ + c) + 1];
      value -= std::max(0, end_potential_ - out - task_.end_cost[c]);
    }
    return value;
  }

  const FlowTask& task_;
  std::uint32_t cells_;
  std::uint32_t last_;
  std::vector<std::int32_t> potential_;  // for each state
  std::vector<std::int32_t> distance_;
  std::vector<std::uint32_t> parent_;
  std::vector<std::uint32_t> before_;  // for each node, the node that the person here comes from, and goes to
  std::vector<std::uint32_t> after_;
  std::vector<std::int32_t> cost_in_;
  std::vector<std::uint32_t> touched_;
  std::vector<std::uint64_t> open_;  // a heap, the least first
  std::int32_t end_potential_ = 0;
  std::int32_t end_distance_ = kFar;
  std::uint32_t end_state_ = 0;
  std::size_t looked_at_ = 0;  // states since the potentials were exact
};

}  // namespace

void Reach::find_back() {
  back.resize(to.size());
  for (std::uint32_t c = 0; c + 1 < first.size(); ++c) {
    for (std::uint32_t a = first[c]; a < first[c + 1]; ++a) {
      const auto begin = to.begin() + first[to[a]];
      const auto end = to.begin() + first[to[a] + 1];
      back[a] = static_cast<std::uint32_t>(std::lower_bound(begin, end, c) - to.begin());
    }
  }
}

std::optional<TimeFlow> cheapest_flow(const FlowTask& task, const Progress& progress) {
  FL_CHECK(!task.intervals.empty() && task.end_cost.size() == task.cells);
  return FlowSearch(task).run(progress);
}

}  // namespace footlight::planner
