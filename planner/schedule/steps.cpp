// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/steps.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>

#include "core/check.hpp"
#include "planner/schedule/push.hpp"
#include "planner/schedule/step_distance.hpp"

namespace footlight::planner {
namespace {

constexpr std::uint32_t kNobody = 0xFFFFFFFFU;
constexpr double kRounding = 1e-9;

class Stepper {
 public:
  explicit Stepper(const StepsTask& task)
      : task_(task),
        grid_(task.ways->grid()),
        distance_(*task.ways),
        columns_(grid_.columns()),
        closed_form_(grid_.kind() == GridKind::square && task.ways->open()),
        least_turn_(least_turn(task)),
        watches_turns_(grid_.kind() == GridKind::hexagonal || least_turn_ > 0),
        occupant_(static_cast<std::size_t>(grid_.size()), kNobody) {}

  std::optional<Steps> run() {
    seat();
    for (const Walker& walker : walkers_) {
      if (!distance_.reachable(walker)) return std::nullopt;
    }
    Steps out;
    out.moves.reserve(expected_moves_);
    moves_ = &out.moves;
    out.first.push_back(0);
    int idle = 0;
    while (anybody_active() && out.count() < task_.most_steps && idle == 0) {
      ++step_;
      const std::size_t before = moves_->size() + exchanges_;
      look_at_everybody(step_ % 2 == 1);
      // Kinds that may not exchange can block each other for good.
      idle = before == moves_->size() + exchanges_ ? 1 : 0;
      if (idle == 0) out.first.push_back(static_cast<std::uint32_t>(out.moves.size()));
    }
    out.arrived = !anybody_active();
    finish(out);
    if (idle != 0) push_aside(task_, out);
    return out;
  }

 private:
  /// Numbers people in the order of their cells.
  void seat() {
    const std::size_t people = task_.from.size();
    FL_CHECK(task_.to.size() == people && (task_.kind.empty() || task_.kind.size() == people));
    for (std::uint32_t i = 0; i < people; ++i) {
      FL_CHECK(occupant_[task_.from[i].at()] == kNobody);
      occupant_[task_.from[i].at()] = i;
    }
    original_.reserve(people);
    walkers_.reserve(people);
    for (std::size_t cell = 0; cell < occupant_.size() && original_.size() < people; ++cell) {
      if (occupant_[cell] == kNobody) continue;
      const std::uint32_t i = occupant_[cell];
      occupant_[cell] = static_cast<std::uint32_t>(original_.size());
      original_.push_back(i);
      goal_.push_back(i);
      const Cell here = grid_.cell(CellIndex::of(cell));
      const Cell goal = grid_.cell(task_.to[i]);
      walkers_.push_back({static_cast<std::int16_t>(here.column), static_cast<std::int16_t>(here.row),
                          static_cast<std::int16_t>(goal.column), static_cast<std::int16_t>(goal.row)});
      expected_moves_ += static_cast<std::size_t>(std::abs(here.column - goal.column) + std::abs(here.row - goal.row));
    }
    done_.assign(people, 0);
    in_chain_.assign(people, 0);
    active_.assign((people + 63) / 64, 0);
    if (watches_turns_) left_.assign(occupant_.size(), {});
    for (std::uint32_t i = 0; i < people; ++i) note(i);
  }

  [[nodiscard]] bool anybody_active() const {
    return std::any_of(active_.begin(), active_.end(), [](std::uint64_t word) { return word != 0; });
  }
  /// Remembers whether somebody has somewhere to go.
  void note(std::uint32_t i) {
    const std::uint64_t bit = std::uint64_t{1} << (i % 64U);
    std::uint64_t& word = active_[i / 64];
    word = walkers_[i].home() ? word & ~bit : word | bit;
  }

  void look_at_everybody(bool forwards) {
    for (std::size_t n = 0; n < active_.size(); ++n) {
      const std::size_t w = forwards ? n : active_.size() - 1 - n;
      // Whoever is woken meanwhile has been looked at by whoever woke her.
      for (std::uint64_t word = active_[w]; word != 0;) {
        const int bit = forwards ? std::countr_zero(word) : 63 - std::countl_zero(word);
        word &= ~(std::uint64_t{1} << static_cast<unsigned>(bit));
        const auto i = static_cast<std::uint32_t>(64 * w + static_cast<std::size_t>(bit));
        if (done_[i] != step_ && !try_step(i)) unblock(i);
      }
    }
  }

  [[nodiscard]] std::size_t cell_of(const Walker& walker) const {
    return static_cast<std::size_t>(walker.row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(walker.column);
  }

  /// Neighbouring cells that are nearer to the goal, the one along the longer way first.
  [[nodiscard]] NextCells next_of(const Walker& walker) {
    if (!closed_form_) return distance_.nearer(walker);
    NextCells next;
    const int dx = walker.goal_column - walker.column;
    const int dy = walker.goal_row - walker.row;
    const auto here = static_cast<std::int32_t>(cell_of(walker));
    const std::int32_t along = here + (dx > 0 ? 1 : -1);
    const std::int32_t up = here + (dy > 0 ? columns_ : -columns_);
    const bool along_first = std::abs(dx) >= std::abs(dy);
    if (dx != 0 && along_first) next.add(along);
    if (dy != 0) next.add(up);
    if (dx != 0 && !along_first) next.add(along);
    return next;
  }

  bool try_step(std::uint32_t i) {
    const NextCells next = next_of(walkers_[i]);
    for (const std::int32_t cell : next) {
      if (occupant_[static_cast<std::size_t>(cell)] != kNobody || !may_follow(i, cell)) continue;
      go(i, static_cast<std::size_t>(cell));
      return true;
    }
    return false;
  }

  void go(std::uint32_t i, std::size_t cell) {
    Walker& walker = walkers_[i];
    const std::size_t before = cell_of(walker);
    if (watches_turns_) left_[before] = {step_, static_cast<std::int32_t>(cell)};
    occupant_[before] = kNobody;
    occupant_[cell] = i;
    // Along a row without a division; in two columns a neighbour in another row may be the next cell, too.
    if (columns_ > 2 && (cell == before + 1 || cell + 1 == before)) {
      walker.column = static_cast<std::int16_t>(cell > before ? walker.column + 1 : walker.column - 1);
    } else {
      const Cell there = grid_.cell(CellIndex::of(cell));
      walker.column = static_cast<std::int16_t>(there.column);
      walker.row = static_cast<std::int16_t>(there.row);
    }
    done_[i] = step_;
    if (walker.home()) note(i);
    moves_->push_back({original_[i], CellIndex::of(cell)});
  }

  /// Whether the turn behind somebody who has just left the cell is gentle enough.
  [[nodiscard]] bool may_follow(std::uint32_t i, std::int32_t cell) const {
    if (!watches_turns_) return true;
    const Left& left = left_[static_cast<std::size_t>(cell)];
    if (left.step != step_) return true;
    const Point middle = grid_.centre(CellIndex::of(cell));
    const Point mine = middle - grid_.centre(CellIndex::of(cell_of(walkers_[i])));
    const double pitch_m = grid_.pitch_m();
    return dot(mine, grid_.centre(CellIndex::of(left.to)) - middle) >= (least_turn_ - kRounding) * pitch_m * pitch_m;
  }

  [[nodiscard]] bool may_exchange(std::uint32_t a, std::uint32_t b) const {
    return task_.kind.empty() || task_.kind[original_[a]] == task_.kind[original_[b]];
  }
  void exchange(std::uint32_t a, std::uint32_t b) {
    std::swap(walkers_[a].goal_column, walkers_[b].goal_column);
    std::swap(walkers_[a].goal_row, walkers_[b].goal_row);
    std::swap(goal_[a], goal_[b]);
    ++exchanges_;
    note(a);
    note(b);
  }

  /// Somebody stands in the way: she goes first, and whoever is in her way before her.
  void unblock(std::uint32_t first) {
    chain_.assign(1, first);
    while (!chain_.empty()) {
      const std::uint32_t i = chain_.back();
      if (done_[i] == step_ || walkers_[i].home() || try_step(i) || !clear_the_way(i)) {
        done_[i] = step_;
        in_chain_[i] = 0;
        chain_.pop_back();
      }
    }
  }

  /// @return true when somebody else has to be looked at before `i` tries again (or `i` has become done)
  bool clear_the_way(std::uint32_t i) {
    for (const std::int32_t cell : next_of(walkers_[i])) {
      const std::uint32_t other = occupant_[static_cast<std::size_t>(cell)];
      if (other == kNobody) continue;
      if (walkers_[other].home() && may_exchange(i, other)) {
        exchange(i, other);
        if (done_[other] == step_) return false;
      } else if (done_[other] == step_ || walkers_[other].home()) {
        continue;
      } else if (in_chain_[other] != 0) {
        return exchange_around(other);
      }
      in_chain_[i] = 1;
      chain_.push_back(other);
      return true;
    }
    return false;
  }

  /// The people from `begin` to the end of the chain block each other in a circle: each takes the goal of whoever wants
  /// her cell, and all stay.
  bool exchange_around(std::uint32_t begin) {
    std::size_t at = chain_.size() - 1;
    for (std::size_t n = chain_.size() - 1; chain_[n] != begin; --n) {
      if (!may_exchange(chain_[n], chain_[n - 1])) return false;
      at = n - 1;
    }
    for (std::size_t n = chain_.size() - 1; n > at; --n) exchange(chain_[n], chain_[n - 1]);
    for (std::size_t n = at; n < chain_.size(); ++n) done_[chain_[n]] = step_;
    return true;
  }

  void finish(Steps& out) const {
    out.last.resize(task_.from.size());
    out.target_of.resize(task_.from.size());
    for (std::size_t i = 0; i < walkers_.size(); ++i) {
      out.last[original_[i]] = CellIndex::of(cell_of(walkers_[i]));
      out.target_of[original_[i]] = goal_[i];
    }
  }

  /// A cell that was left in some step, and where to.
  struct Left {
    std::uint32_t step = 0;
    std::int32_t to = 0;
  };

  const StepsTask& task_;
  const Grid& grid_;
  StepDistance distance_;
  std::int32_t columns_;
  bool closed_form_;
  double least_turn_;
  bool watches_turns_;
  std::vector<std::uint32_t> occupant_;  // of each cell
  std::vector<Walker> walkers_;          // in the order of their first cells
  std::vector<std::uint32_t> original_;  // of each walker, the position in `from`
  std::vector<std::uint32_t> goal_;      // of each walker, the position in `to`
  std::vector<std::uint32_t> done_;      // of each walker, the last step in which she was looked at
  std::vector<char> in_chain_;
  std::vector<std::uint64_t> active_;  // a bit a walker: not at her goal
  std::vector<std::uint32_t> chain_;
  std::vector<Left> left_;
  std::vector<Steps::Move>* moves_ = nullptr;
  std::size_t expected_moves_ = 0;
  std::size_t exchanges_ = 0;
  std::uint32_t step_ = 0;
};

}  // namespace

std::optional<Steps> step_through(const StepsTask& task) { return Stepper(task).run(); }

}  // namespace footlight::planner
