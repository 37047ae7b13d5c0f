// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <queue>
#include <tuple>
#include <unordered_set>
#include <vector>

#include "planner/motion/cell_steps.hpp"
#include "planner/way_in/stretch.hpp"

namespace footlight::planner {

/// One question: best first over cells and beats. Used once.
class WayInSearch {
 public:
  WayInSearch(const Plan& plan, const Ways& ways, const CellSteps& steps, double reach_m,
              const WaysIn::Stretch& stretch, const WayInTask& task);

  /// Marks to her own walk; nothing when none was found.
  [[nodiscard]] std::optional<std::vector<Mark>> to_own_walk();
  /// Marks to the nearest cell where she can stand to the end of the stretch, her own one included.
  [[nodiscard]] std::optional<std::vector<Mark>> to_refuge();
  /// The beat at which she begins, and up to which beat all was looked at.
  [[nodiscard]] Instant begins() const { return beat(first_); }
  [[nodiscard]] Instant ends() const { return beat(last_); }

 private:
  /// Where her own walk can be met.
  struct Goal {
    Instant time;
    CellIndex cell;
    bool on_beat = true;
  };
  struct State {
    CellIndex cell;
    Instant time;
    std::uint32_t beat = 0;    ///< kOffBeat: a goal between two beats
    std::uint32_t before = 0;  ///< position in the states
    double walked_m = 0;
    bool looked_at = false;
  };
  struct Entry {
    Instant joins;
    double way_m = 0;
    Instant time;  ///< of equals who is further in time
    std::uint32_t state = 0;
    friend bool operator<(const Entry& a, const Entry& b) {
      return std::tie(b.joins, b.way_m, a.time, b.state) < std::tie(a.joins, a.way_m, b.time, a.state);
    }
  };
  enum class Aim : std::uint8_t { own_walk, refuge };

  [[nodiscard]] std::optional<std::vector<Mark>> search(Aim aim);
  void find_goals();
  void push(State state);
  void expand(std::uint32_t state);
  void shoot(std::uint32_t state);
  [[nodiscard]] bool arrived(const State& state) const;
  [[nodiscard]] const Goal* soonest(CellIndex cell, Instant time) const;
  [[nodiscard]] bool can_walk(const Mark& from, const Mark& to) const;
  [[nodiscard]] bool clear(const Mark& from, const Mark& to) const;
  [[nodiscard]] std::vector<Mark> marks_to(std::uint32_t state) const;
  void simplify(std::vector<Mark>& marks) const;
  [[nodiscard]] Instant beat(std::uint32_t k) const { return stretch_.beats()[k]; }
  [[nodiscard]] double reach_of(Duration time) const { return speed_mps_ * to_seconds(time) + kRounding_m; }

  static constexpr double kRounding_m = 1e-9;
  static constexpr std::uint32_t kOffBeat = UINT32_MAX;

  const Plan& plan_;
  const Grid& grid_;
  const Ways& ways_;
  const CellSteps& steps_;
  double reach_m_;
  const WaysIn::Stretch& stretch_;
  const WayInTask& task_;
  double speed_mps_;
  std::uint32_t first_ = 0;  ///< beat
  std::uint32_t last_ = 0;
  std::vector<Goal> goals_;
  std::vector<std::pair<PerformerIndex, std::vector<Knot>>> given_;
  Aim aim_ = Aim::own_walk;
  std::vector<State> states_;
  std::unordered_set<std::uint64_t> closed_;
  std::priority_queue<Entry> queue_;
};

}  // namespace footlight::planner
