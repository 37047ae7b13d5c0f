// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/plan.hpp"

namespace footlight::planner::judge {

/// Somebody stands on the middle of a cell.
struct Stand {
  Instant time;
  CellIndex cell;
  Point at;
};

/// Everybody's way through the show, made from a plan's marks so that it can be measured whatever the plan looks like:
/// sorted by time, one mark an instant, marks off the grid left out.
class Walks {
 public:
  explicit Walks(const Plan& plan);
  /// Only what is needed to know where everybody is in [from, to]; tracks in wrong order of time are kept whole.
  Walks(const Plan& plan, Instant from, Instant to);

  [[nodiscard]] std::uint32_t people() const { return static_cast<std::uint32_t>(tracks_.size()); }
  /// Empty for somebody without a usable mark.
  [[nodiscard]] const std::vector<Stand>& track(std::uint32_t person) const { return tracks_[person]; }
  /// All instants at which anybody has a mark, ascending.
  [[nodiscard]] const std::vector<Instant>& times() const { return times_; }
  /// How many people have a mark at times()[i].
  [[nodiscard]] const std::vector<std::uint32_t>& marks_at() const { return marks_at_; }

  /// Index of the last stand at or before `time`; 0 before the first. O(log marks)
  [[nodiscard]] std::size_t stand_before(std::uint32_t person, Instant time) const;
  /// Where somebody is whose last stand at or before `time` has index `before`; stands before the first mark and after
  /// the last.
  [[nodiscard]] Point position(std::uint32_t person, std::size_t before, Instant time) const;
  [[nodiscard]] Point position(std::uint32_t person, Instant time) const {
    return position(person, stand_before(person, time), time);
  }

 private:
  void add_track(const Grid& grid, std::span<const Mark> marks);
  void gather_times();

  std::vector<std::vector<Stand>> tracks_;
  std::vector<Instant> times_;
  std::vector<std::uint32_t> marks_at_;
};

}  // namespace footlight::planner::judge
