// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/snap.hpp"

#include <algorithm>
#include <array>
#include <optional>

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
        wanted_here_(static_cast<std::size_t>(grid_.size()), 0),
        hold_(task.now.size(), 0),
        slow_(task.now.size(), 0) {
    for (const CellIndex cell : task.own) wanted_here_[cell.at()] = 1;
  }

  std::vector<CellIndex> run(std::span<const char> hold, std::span<const char> slow) {
    changed_.assign(slow_.size(), 0);
    for (std::size_t i = 0; i < slow.size(); ++i) changed_[i] = slow[i] != slow_[i] ? 1 : 0;
    hold_.assign(hold.begin(), hold.end());
    slow_.assign(slow.begin(), slow.end());
    hold_.resize(changed_.size(), 0);
    slow_.resize(changed_.size(), 0);
    for (;; ++level_) {
      std::vector<CellIndex> next = stand();
      if (std::find(moving_.begin(), moving_.end(), 1) == moving_.end()) {
        places_.reset();
        return next;
      }
      places_ ? offer() : offer_all();
      if (places_->seat_all()) {
        for (std::uint32_t i = 0; i < next.size(); ++i) {
          if (moving_[i] != 0) next[i] = places_->place_of(i);
        }
        return next;
      }
      places_.reset();
      FL_CHECK(level_ != kTogether);  // staying where they are is always an answer
    }
  }

 private:
  /// Around the aim, where people on the way may stand, pitches; the second where the first has no answer, and where
  /// that has none, either, everybody may be displaced.
  static constexpr std::array kRadii{2.3, 5.2};
  static constexpr std::size_t kTogether = kRadii.size();

  /// Who stays and who is on time; everybody else is `moving_`, or together everybody who need not stay.
  std::vector<CellIndex> stand() {
    taken_before_ = taken_;
    moving_before_ = moving_;
    on_time_before_ = on_time_;
    std::fill(taken_.begin(), taken_.end(), char{0});
    moving_.assign(hold_.size(), 0);
    on_time_.assign(hold_.size(), 0);
    std::vector<CellIndex> next(task_.now.begin(), task_.now.end());
    for (std::size_t i = 0; i < next.size(); ++i) {
      if (hold_[i] != 0) taken_[task_.now[i].at()] = 1;
    }
    for (std::size_t i = 0; i < next.size(); ++i) {
      if (hold_[i] != 0) continue;
      on_time_[i] = on_time(i) ? 1 : 0;
      moving_[i] = on_time_[i] == 0 || level_ == kTogether ? 1 : 0;
      if (moving_[i] != 0) continue;
      next[i] = task_.own[i];
      taken_[next[i].at()] = 1;
    }
    return next;
  }

  void offer_all() {
    places_.emplace(moving_.size(), taken_.size());
    for (std::size_t c = 0; c < taken_.size(); ++c) {
      if (taken_[c] != 0) places_->close(CellIndex::of(c));
    }
    for (std::uint32_t i = 0; i < moving_.size(); ++i) {
      if (moving_[i] != 0) places_->choose(i, places(i));
    }
  }

  /// What is different from the round before.
  void offer() {
    for (std::size_t c = 0; c < taken_.size(); ++c) {
      if (taken_[c] == taken_before_[c]) continue;
      taken_[c] != 0 ? places_->close(CellIndex::of(c)) : places_->open(CellIndex::of(c));
    }
    for (std::uint32_t i = 0; i < moving_.size(); ++i) {
      const bool other = changed_[i] != 0 || moving_[i] != moving_before_[i] || on_time_[i] != on_time_before_[i];
      if (other) places_->choose(i, moving_[i] != 0 ? places(i) : std::vector<Choice>());
    }
  }

  [[nodiscard]] std::vector<Choice> places(std::size_t slot) const {
    if (on_time_[slot] != 0) return places_nearby(slot);
    return places_on_the_way(slot, kRadii[level_ % kTogether] * pitch_);
  }

  [[nodiscard]] double longest_m(std::size_t slot) const {
    return slow_[slot] != 0 ? std::min(task_.slow_m, task_.longest_m) : task_.longest_m;
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
      if (!ways_.can_stand(cell) || !reachable(slot, cell)) continue;
      choices.push_back({cell, cost(slot, at, cell)});
    }
    add_staying(slot, at, choices);
    return choices;
  }

  void add_staying(std::size_t slot, Point at, std::vector<Choice>& choices) const {
    const CellIndex stay = task_.now[slot];
    const bool listed = std::any_of(choices.begin(), choices.end(), [&](const Choice& c) { return c.cell == stay; });
    // Where something that moves comes next she stays only when there is nowhere else.
    const double in_the_way = ways_.can_stand(stay) ? 0 : kTooFarFromGoal;
    if (!listed) choices.push_back({stay, 100 + in_the_way + cost(slot, at, stay)});
  }

  /// Of somebody who could be on time.
  [[nodiscard]] std::vector<Choice> places_nearby(std::size_t slot) const {
    std::vector<Choice> choices{{task_.own[slot], 0.0}};
    const Point at = grid_.centre(task_.own[slot]);
    for (const CellIndex cell : grid_.within(at, 1.5 * pitch_)) {
      if (cell == task_.own[slot] || !ways_.can_stand(cell) || !reachable(slot, cell)) continue;
      choices.push_back({cell, 10 + cost(slot, at, cell)});
    }
    add_staying(slot, at, choices);
    return choices;
  }

  const SnapTask& task_;
  const Ways& ways_;
  const Grid& grid_;
  double pitch_;
  CellFlags taken_;  ///< by who stays or is on time
  CellFlags wanted_here_;
  std::vector<char> hold_;
  std::vector<char> slow_;
  std::vector<char> moving_;
  std::vector<char> on_time_;
  std::vector<char> changed_;  ///< slow, and was not in the round before, or the other way round
  CellFlags taken_before_;     ///< in the round before
  std::vector<char> moving_before_;
  std::vector<char> on_time_before_;
  std::size_t level_ = 0;         ///< into kRadii, or kTogether; kept, since choices hardly grow from round to round
  std::optional<Places> places_;  ///< of the round before; nothing: to be found anew
};

}  // namespace

struct Snap::State {
  explicit State(const SnapTask& of) : task(of), snapper(task) {}
  SnapTask task;
  Snapper snapper;
};

Snap::Snap(const SnapTask& task) : state_(std::make_unique<State>(task)) {}
Snap::~Snap() = default;

std::vector<CellIndex> Snap::cells(std::span<const char> hold, std::span<const char> slow) {
  return state_->snapper.run(hold, slow);
}

std::vector<CellIndex> snap(const SnapTask& task) { return Snap(task).cells(task.hold, task.slow); }

}  // namespace footlight::planner
