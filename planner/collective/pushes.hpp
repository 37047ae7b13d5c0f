// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/grid.hpp"
#include "planner/collective/social_force.hpp"

namespace footlight::planner::collective {

/// Beyond so many ranges from where two touch nothing is felt: a force has fallen to exp(-this).
inline constexpr double kCutOff = 3.5;

/// People around somebody, side by side, to be felt at once.
class Around {
 public:
  /// Forgets everybody, and makes room for so many.
  void clear(std::size_t most);
  /// @param away from the other  @param touch_m sum of both radii  @param stranger of another sub-group
  /// Who is beyond `squared_reach`, or on the same point, is not taken; without a branch, since nothing foretells it.
  void add(Point away, double squared_reach, double touch_m, bool stranger) {
    const double squared = squared_length(away);
    x_[people_] = away.x;
    y_[people_] = away.y;
    touch_m_[people_] = touch_m;
    stranger_[people_] = stranger ? 1 : 0;
    const std::size_t taken =
        static_cast<std::size_t>(squared <= squared_reach) & static_cast<std::size_t>(squared > 0);
    people_ += taken;
    strangers_ += taken & static_cast<std::size_t>(stranger);
  }
  [[nodiscard]] std::size_t people() const { return people_; }

  struct Sums {
    Point own;        ///< Eq. 10 of those of her sub-group, m/s^2
    Point strangers;  ///< Eq. 10 and 22 of all others
  };
  /// What all of them do to her, `repulse_force` added up; sums run in one order on every processor.
  [[nodiscard]] Sums pushes(Falloff repulsion, Falloff separation);

 private:
  std::vector<double> x_, y_, touch_m_, stranger_;
  std::size_t people_ = 0;
  std::size_t strangers_ = 0;
};

}  // namespace footlight::planner::collective
