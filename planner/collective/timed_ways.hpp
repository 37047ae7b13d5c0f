// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/grid.hpp"
#include "core/result.hpp"
#include "planner/collective/walk_field.hpp"
#include "planner/motion/crowd.hpp"

namespace footlight::planner::collective {

/// Corners of everybody's ideal way and when she should be there: straight from place to place where nothing is in the
/// way, around what is blocked, and along the path of her group, on which the formation changes evenly with the way of
/// its middle.
class TimedWays {
 public:
  struct Corner {
    Point at;
    double at_s = 0;
    double left_m = 0;  ///< from here to the end of the leg
    double end_s = 0;   ///< when the leg that begins here ends; of the last corner its own time
    bool timed = true;  ///< an end of a leg; else a corner of what is in the way
  };

  /// @param to of each person  @param around nothing: the floor is open  @param arrive_s when everybody should be there
  /// @return ErrorKind::input when somebody cannot get to her place or to her group's path
  static Result<TimedWays> make(const MotionTask& task, std::span<const Point> to, const WalkField* around,
                                double arrive_s);

  [[nodiscard]] std::size_t people() const { return first_.size() - 1; }
  [[nodiscard]] std::span<const Corner> of(std::size_t person) const {
    return std::span(corners_).subspan(first_[person], first_[person + 1] - first_[person]);
  }
  /// Where she should be. O(log corners)
  [[nodiscard]] Point place(std::size_t person, double at_s) const;

  struct Aside {
    Point by;
    double from_s = 0;
    double until_s = 0;
    double lead_s = 0;  ///< for the step there, before from_s, and for the one back, after until_s
  };
  /// Everybody of `who` goes beside her way for a while; whose way would then meet something blocked or leave the
  /// floor, and whose way leads around something, stays on it.
  void step_aside(std::span<const std::uint32_t> who, const Aside& aside, const MotionFloor& floor);

 private:
  void append(std::vector<Corner> way);
  [[nodiscard]] std::vector<Corner> stepped_aside(std::size_t person, const Aside& aside) const;

  std::vector<std::uint32_t> first_{0};
  std::vector<Corner> corners_;
};

}  // namespace footlight::planner::collective
