// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

namespace footlight::planner {

/// How far two people keep from each other: the clearance, or the sum of their radii where that is more, and no more
/// than neighbours who stand still can.
class Room {
 public:
  /// @param radius_m of each person; empty: the clearance holds for everybody
  Room(double clearance_m, std::span<const double> radius_m, double pitch_m)
      : clearance_m_(clearance_m), pitch_m_(pitch_m), radius_m_(radius_m), widest_m_(clearance_m) {
    double first = 0;
    double second = 0;
    for (const double radius : radius_m) {
      second = std::max(second, std::min(first, radius));
      first = std::max(first, radius);
    }
    widest_m_ = std::max(clearance_m, std::min(first + second, pitch_m));
  }

  [[nodiscard]] double between_m(std::uint32_t a, std::uint32_t b) const {
    if (radius_m_.empty()) return clearance_m_;
    return std::max(clearance_m_, std::min(radius_m_[a] + radius_m_[b], pitch_m_));
  }
  /// No two people keep more.
  [[nodiscard]] double widest_m() const { return widest_m_; }

 private:
  double clearance_m_;
  double pitch_m_;
  std::span<const double> radius_m_;
  double widest_m_;
};

}  // namespace footlight::planner
