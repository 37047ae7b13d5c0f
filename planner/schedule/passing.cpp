// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/passing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>

#include "core/check.hpp"
#include "planner/repair/lateness.hpp"
#include "planner/repair/room.hpp"

namespace footlight::planner {
namespace {

constexpr double kRounding_m = 1e-9;
constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();
constexpr CellIndex kNowhere{kNobody};
/// How far somebody goes in a step, pitches. Cells at these distances lie in many directions: no walk loses more than a
/// tenth by going over them, but for the last two.
constexpr std::array kStrides{3.17, 2.25, 1.75, 1.42, 1.01};
/// Nobody is pushed by more people than this, one after the other.
constexpr int kDeepest = 1500;
/// Steps without anybody getting nearer than ever after which it is given up.
constexpr int kPatience = 40;
/// So many times the time that there is are looked at.
constexpr double kMostTimes = 12;

/// How far cells are from targets: straight where the stage is open, else over neighbouring cells.
class Remaining {
 public:
  explicit Remaining(const Ways& ways) : ways_(ways), grid_(ways.grid()) {}

  [[nodiscard]] double m(CellIndex from, CellIndex to) {
    const double straight = distance(grid_.centre(from), grid_.centre(to));
    if (ways_.open()) return straight;
    const std::vector<std::uint16_t>& field = field_to(to);
    // Steps first; the straight way tells equals apart.
    return field[from.at()] == kFar ? kNever : grid_.pitch_m() * field[from.at()] + 1e-3 * straight;
  }
  static constexpr double kNever = std::numeric_limits<double>::infinity();

 private:
  static constexpr std::uint16_t kFar = std::numeric_limits<std::uint16_t>::max();

  const std::vector<std::uint16_t>& field_to(CellIndex goal) {
    std::vector<std::uint16_t>& field = fields_[goal];
    if (!field.empty()) return field;
    field.assign(static_cast<std::size_t>(grid_.size()), kFar);
    field[goal.at()] = 0;
    std::vector<CellIndex> queue{goal};
    for (std::size_t n = 0; n < queue.size(); ++n) {
      for (const CellIndex next : grid_.neighbours(queue[n])) {
        if (field[next.at()] != kFar || !ways_.can_stand(next)) continue;
        if (!ways_.straight(grid_.centre(queue[n]), grid_.centre(next))) continue;
        field[next.at()] = static_cast<std::uint16_t>(field[queue[n].at()] + 1);
        queue.push_back(next);
      }
    }
    return field;
  }

  const Ways& ways_;
  const Grid& grid_;
  std::map<CellIndex, std::vector<std::uint16_t>> fields_;
};

/// One trial: steps of one length.
class Passer {
 public:
  Passer(const PassTask& task, double stride, bool late, Remaining& remaining)
      : task_(task),
        ways_(*task.ways),
        grid_(task.ways->grid()),
        remaining_(remaining),
        stride_m_(stride * grid_.pitch_m()),
        limit_m_(0),
        late_share_(late ? std::min(1.0, task.lag_s * task.speed_mps / stride_m_) : 0),
        moves_(static_cast<std::size_t>(grid_.size())),
        now_at_(static_cast<std::size_t>(grid_.size()), kNobody),
        next_at_(static_cast<std::size_t>(grid_.size()), kNobody) {
    // Numbered by cells, so that the result does not depend on how people are.
    order_.resize(task.from.size());
    std::iota(order_.begin(), order_.end(), 0U);
    std::sort(order_.begin(), order_.end(), [&](auto a, auto b) { return task.from[a] < task.from[b]; });
    for (const std::uint32_t i : order_) {
      now_at_[task.from[i].at()] = static_cast<std::uint32_t>(now_.size());
      now_.push_back(task.from[i]);
      goal_.push_back(i);
      waited_.push_back(0);
      if (!task.radius_m.empty()) radius_m_.push_back(task.radius_m[i]);
    }
    room_ = Room(task.clearance_m, radius_m_, grid_.pitch_m());
    limit_m_ = room_.widest_m();
  }

  /// @param most_s more is not looked for
  std::optional<Passing> run(double most_s, const Progress& progress) {
    Passing out;
    out.at.push_back(numbered());
    double nearest_m = std::numeric_limits<double>::infinity();
    for (int idle = 0; !home();) {
      if (progress.stopped()) return std::nullopt;
      const double walked_m = step(out);
      out.longest_m.push_back(walked_m);
      out.needed_s += walked_m / task_.speed_mps;
      out.at.push_back(numbered());
      const double left_m = left();
      idle = left_m < nearest_m - 1e-6 ? 0 : idle + 1;
      nearest_m = std::min(nearest_m, left_m);
      if (walked_m == 0 || idle > kPatience || out.needed_s > most_s) return std::nullopt;
    }
    out.target_of.resize(now_.size());
    for (std::size_t n = 0; n < now_.size(); ++n) out.target_of[order_[n]] = goal_[n];
    out.tolerates_lag = late_share_ > 0;
    return out;
  }

 private:
  [[nodiscard]] CellIndex target(std::uint32_t who) const { return task_.to[goal_[who]]; }
  [[nodiscard]] bool home() const {
    for (std::uint32_t i = 0; i < now_.size(); ++i) {
      if (now_[i] != target(i)) return false;
    }
    return true;
  }
  [[nodiscard]] double left() {
    double sum = 0;
    for (std::uint32_t i = 0; i < now_.size(); ++i) sum += remaining_.m(now_[i], target(i));
    return sum;
  }
  [[nodiscard]] std::vector<CellIndex> numbered() const {
    std::vector<CellIndex> out(now_.size());
    for (std::size_t n = 0; n < now_.size(); ++n) out[order_[n]] = now_[n];
    return out;
  }

  /// @return the longest walk of the step, m
  double step(Passing& out) {
    next_.assign(now_.size(), kNowhere);
    std::vector<std::uint32_t> turn(now_.size());
    std::iota(turn.begin(), turn.end(), 0U);
    std::vector<double> away(now_.size());
    for (std::uint32_t i = 0; i < now_.size(); ++i) away[i] = remaining_.m(now_[i], target(i));
    std::stable_sort(turn.begin(), turn.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::tuple(-waited_[a], -away[a]) < std::tuple(-waited_[b], -away[b]);
    });
    for (const std::uint32_t i : turn) {
      if (next_[i] == kNowhere) choose(i, 0);
    }
    double longest_m = 0;
    for (std::uint32_t i = 0; i < now_.size(); ++i) {
      const double walk_m = distance(grid_.centre(now_[i]), grid_.centre(next_[i]));
      longest_m = std::max(longest_m, walk_m);
      now_at_[now_[i].at()] = kNobody;
      if (next_[i] == target(i) && now_[i] != next_[i]) out.last = order_[i];
    }
    for (std::uint32_t i = 0; i < now_.size(); ++i) {
      next_at_[next_[i].at()] = kNobody;
      now_[i] = next_[i];
      now_at_[now_[i].at()] = i;
      waited_[i] = now_[i] == target(i) ? 0 : waited_[i] + 1;
    }
    return longest_m;
  }

  /// Cells to which somebody can go from a cell in a step, itself among them.
  const std::vector<CellIndex>& moves_from(CellIndex cell) {
    std::vector<CellIndex>& moves = moves_[cell.at()];
    if (!moves.empty()) return moves;
    const Point here = grid_.centre(cell);
    for (const CellIndex to : grid_.within(here, stride_m_)) {
      if (to == cell || (ways_.can_stand(to) && ways_.straight(here, grid_.centre(to)))) moves.push_back(to);
    }
    return moves;
  }

  [[nodiscard]] bool clear(std::uint32_t a, CellIndex a_to, std::uint32_t b, CellIndex b_to) const {
    const Walk one{grid_.centre(now_[a]), grid_.centre(a_to)};
    const Walk two{grid_.centre(now_[b]), grid_.centre(b_to)};
    const double least_m = room_.between_m(a, b) - kRounding_m;
    if (closest_approach(one, two).distance_m < least_m) return false;
    return late_share_ == 0 || least_squared_when_late_m2({one}, {two}, late_share_) >= least_m * least_m;
  }

  /// Whether a walk is clear of all that have been chosen and of whoever could stay, but for who stands at its end.
  bool clear_of_all(std::uint32_t who, CellIndex to) {
    const Point from = grid_.centre(now_[who]);
    const Point end = grid_.centre(to);
    const double reach_m = stride_m_ + limit_m_ + 0.5 * distance(from, end);
    for (const CellIndex cell : near(now_[who], to, reach_m)) {
      const std::uint32_t other = now_at_[cell.at()];
      if (other == kNobody || other == who) continue;
      if (next_[other] == kNowhere && cell == to) continue;  // has to leave
      const CellIndex its = next_[other] == kNowhere ? cell : next_[other];
      if (!clear(who, to, other, its)) return false;
    }
    return true;
  }

  [[nodiscard]] std::vector<CellIndex> near(CellIndex from, CellIndex to, double reach_m) const {
    return grid_.within(0.5 * (grid_.centre(from) + grid_.centre(to)), reach_m);
  }

  /// The nearest to the target first; of equals those on which nobody stands, then by index.
  [[nodiscard]] std::vector<CellIndex> wishes(std::uint32_t who) {
    std::vector<std::tuple<double, int, CellIndex>> ranked;
    for (const CellIndex cell : moves_from(now_[who])) {
      const std::uint32_t there = now_at_[cell.at()];
      ranked.emplace_back(std::round(1e6 * remaining_.m(cell, target(who))), there != kNobody && there != who ? 1 : 0,
                          cell);
    }
    std::sort(ranked.begin(), ranked.end());
    std::vector<CellIndex> out;
    for (const auto& [away, taken, cell] : ranked) out.push_back(cell);
    return out;
  }

  /// @param depth how many people push each other up to her; 0: nobody wants her cell
  /// @return false when she cannot leave, and stays
  bool choose(std::uint32_t who, int depth) {
    for (const CellIndex cell : wishes(who)) {
      if (depth > 0 && cell == now_[who]) continue;
      if (next_at_[cell.at()] != kNobody || !clear_of_all(who, cell)) continue;
      const std::uint32_t there = now_at_[cell.at()];
      const bool push = there != kNobody && there != who && next_[there] == kNowhere;
      if (push && depth >= kDeepest) continue;
      next_[who] = cell;
      next_at_[cell.at()] = who;
      if (!push) return true;
      exchange_targets(who, there);
      if (choose(there, depth + 1)) return true;
      next_[who] = kNowhere;  // `there` stays, and has the cell
    }
    next_[who] = now_[who];
    next_at_[now_[who].at()] = who;
    return depth == 0;
  }

  /// Who pushes somebody of her own kind takes over that one's target where that is nearer for both together.
  void exchange_targets(std::uint32_t a, std::uint32_t b) {
    if (!task_.kind.empty() && task_.kind[order_[a]] != task_.kind[order_[b]]) return;
    const double now_m = remaining_.m(now_[a], target(a)) + remaining_.m(now_[b], target(b));
    const double then_m = remaining_.m(now_[a], target(b)) + remaining_.m(now_[b], target(a));
    if (then_m >= now_m - 1e-6) return;
    std::swap(goal_[a], goal_[b]);
  }

  const PassTask& task_;
  const Ways& ways_;
  const Grid& grid_;
  Remaining& remaining_;
  double stride_m_;
  double limit_m_;  ///< of any two people
  double late_share_;
  std::vector<double> radius_m_;
  Room room_{0, {}, 0};
  std::vector<std::vector<CellIndex>> moves_;
  std::vector<std::uint32_t> order_;  // by cell
  std::vector<CellIndex> now_;
  std::vector<CellIndex> next_;
  std::vector<std::uint32_t> now_at_;
  std::vector<std::uint32_t> next_at_;
  std::vector<std::uint32_t> goal_;  // position in to
  std::vector<int> waited_;          // steps since she was at her target
};

}  // namespace

std::optional<Passing> pass(const PassTask& task, const Progress& progress) {
  FL_CHECK(task.from.size() == task.to.size() && task.speed_mps > 0);
  Remaining remaining(*task.ways);
  for (std::size_t i = 0; i < task.from.size(); ++i) {
    if (remaining.m(task.from[i], task.to[i]) == Remaining::kNever) return std::nullopt;
  }
  std::optional<Passing> best;
  const auto limit_s = [&] { return best ? best->needed_s : kMostTimes * std::max(task.time_s, 1.0); };
  for (const bool late : {true, false}) {
    if (late && task.lag_s <= 0) continue;
    for (const double stride : kStrides) {
      auto found = Passer(task, stride, late, remaining).run(limit_s(), progress);
      if (progress.stopped()) return std::nullopt;
      if (!found || (best && found->needed_s >= best->needed_s)) continue;
      best = std::move(found);
      if (best->needed_s <= task.time_s) return best;
    }
  }
  return best;
}

}  // namespace footlight::planner
