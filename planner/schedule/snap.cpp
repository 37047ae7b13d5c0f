// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/snap.hpp"

#include <algorithm>

#include "core/check.hpp"
#include "planner/schedule/places.hpp"

namespace footlight::planner {
namespace {

/// What it costs to stand where the next exact formation cannot be reached from, before it is weighed by how much.
constexpr double kTooFarFromGoal = 1000;

class Snapper {
 public:
  explicit Snapper(const SnapTask& task)
      : task_(task),
        ways_(*task.ways),
        grid_(task.ways->grid()),
        pitch_(grid_.pitch_m()),
        taken_(static_cast<std::size_t>(grid_.size()), 0),
        wanted_here_(static_cast<std::size_t>(grid_.size()), 0) {
    for (const CellIndex cell : task.own) wanted_here_[cell.at()] = 1;
  }

  std::vector<CellIndex> run() {
    const std::size_t people = task_.now.size();
    std::vector<CellIndex> next(people);
    std::vector<std::size_t> moving;
    for (std::size_t i = 0; i < people; ++i) {
      if (holds(i)) taken_[task_.now[i].at()] = 1;
    }
    for (std::size_t i = 0; i < people; ++i) {
      if (holds(i)) {
        next[i] = task_.now[i];
      } else if (on_time(i)) {
        next[i] = task_.own[i];
        taken_[next[i].at()] = 1;
      } else {
        moving.push_back(i);
      }
    }
    if (moving.empty()) return next;
    for (const double radius : {2.3 * pitch_, 5.2 * pitch_}) {
      std::vector<std::vector<Choice>> choices;
      choices.reserve(moving.size());
      for (const std::size_t i : moving) choices.push_back(places_on_the_way(i, radius));
      const auto placed = cheapest_places(choices, taken_.size());
      if (!placed) continue;
      for (std::size_t m = 0; m < moving.size(); ++m) next[moving[m]] = (*placed)[m];
      return next;
    }
    return together();
  }

 private:
  [[nodiscard]] bool holds(std::size_t slot) const { return !task_.hold.empty() && task_.hold[slot] != 0; }

  [[nodiscard]] double longest_m(std::size_t slot) const {
    return !task_.slow.empty() && task_.slow[slot] != 0 ? std::min(task_.slow_m, task_.longest_m) : task_.longest_m;
  }

  [[nodiscard]] bool reachable(std::size_t slot, CellIndex cell) const {
    const Point from = grid_.centre(task_.now[slot]);
    const Point to = grid_.centre(cell);
    return cell == task_.now[slot] || (distance(from, to) <= longest_m(slot) && ways_.straight(from, to));
  }

  [[nodiscard]] bool on_time(std::size_t slot) const {
    const CellIndex own = task_.own[slot];
    return task_.wanted[slot].own && taken_[own.at()] == 0 && beyond_goal_m(slot, grid_.centre(own)) <= 0 &&
           reachable(slot, own);
  }

  /// How much too far a place is from where the slot must be at the next exact formation; straight, so that a way
  /// around blocked cells may be longer.
  [[nodiscard]] double beyond_goal_m(std::size_t slot, Point at) const {
    if (task_.goal.empty() || task_.goal[slot] == kNoGoal) return 0;
    return std::max(0.0, distance(at, grid_.centre(task_.goal[slot])) - task_.goal_m);
  }

  [[nodiscard]] Point aim(std::size_t slot) const {
    const Point from = grid_.centre(task_.now[slot]);
    const Point there = ways_.toward(from, task_.wanted[slot].at, paced_m(longest_m(slot), pitch_)).at;
    if (beyond_goal_m(slot, there) <= 0) return there;
    return ways_.toward(from, grid_.centre(task_.goal[slot]), paced_m(longest_m(slot), pitch_)).at;
  }

  [[nodiscard]] double cost(std::size_t slot, Point aim_at, CellIndex cell) const {
    const Point centre = grid_.centre(cell);
    double sum = squared_length(centre - aim_at) / (pitch_ * pitch_);
    if (wanted_here_[cell.at()] == 0) sum += 0.5;
    if (!task_.onward.empty()) {
      // Who could be on time from elsewhere should not be put where it is too far.
      const Wanted& after = task_.onward[slot];
      const bool in_time = distance(aim_at, after.at) <= task_.onward_m;
      if (in_time && distance(centre, after.at) > task_.onward_m) sum += 25;
    }
    const double beyond = beyond_goal_m(slot, centre) / pitch_;
    if (beyond > 0) sum += kTooFarFromGoal + beyond * beyond;
    return sum;
  }

  [[nodiscard]] std::vector<Choice> places_on_the_way(std::size_t slot, double radius) const {
    std::vector<Choice> choices;
    const Point at = aim(slot);
    for (const CellIndex cell : grid_.within(at, radius)) {
      if (taken_[cell.at()] != 0 || !ways_.can_stand(cell) || !reachable(slot, cell)) continue;
      choices.push_back({cell, cost(slot, at, cell)});
    }
    const CellIndex stay = task_.now[slot];
    const bool listed = std::any_of(choices.begin(), choices.end(), [&](const Choice& c) { return c.cell == stay; });
    if (!listed && taken_[stay.at()] == 0) choices.push_back({stay, 100 + cost(slot, at, stay)});
    return choices;
  }

  /// Everybody may be displaced. Staying where they are is always an answer.
  std::vector<CellIndex> together() {
    std::fill(taken_.begin(), taken_.end(), char{0});
    for (std::size_t i = 0; i < task_.now.size(); ++i) {
      if (holds(i)) taken_[task_.now[i].at()] = 1;
    }
    std::vector<std::vector<Choice>> choices(task_.now.size());
    for (std::size_t i = 0; i < choices.size(); ++i) {
      if (holds(i)) {
        choices[i] = {{task_.now[i], 0.0}};
        continue;
      }
      const bool in_time = on_time(i);
      choices[i] = in_time ? std::vector<Choice>{{task_.own[i], 0.0}} : places_on_the_way(i, 2.3 * pitch_);
      if (!in_time) continue;
      const Point at = grid_.centre(task_.own[i]);
      for (const CellIndex cell : grid_.within(at, 1.5 * pitch_)) {
        if (cell == task_.own[i] || taken_[cell.at()] != 0 || !ways_.can_stand(cell) || !reachable(i, cell)) continue;
        choices[i].push_back({cell, 10 + cost(i, at, cell)});
      }
      const CellIndex stay = task_.now[i];
      const bool listed =
          std::any_of(choices[i].begin(), choices[i].end(), [&](const Choice& c) { return c.cell == stay; });
      if (!listed) choices[i].push_back({stay, 100 + cost(i, at, stay)});
    }
    auto placed = cheapest_places(choices, taken_.size());
    FL_CHECK(placed.has_value());
    return std::move(*placed);
  }

  const SnapTask& task_;
  const Ways& ways_;
  const Grid& grid_;
  double pitch_;
  CellFlags taken_;
  CellFlags wanted_here_;
};

}  // namespace

std::vector<CellIndex> snap(const SnapTask& task) { return Snapper(task).run(); }

}  // namespace footlight::planner
