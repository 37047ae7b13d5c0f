// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/grid.hpp"
#include "planner/motion/floor.hpp"

namespace footlight::planner::srd {

/// Degree of congestion of square spaces of the floor:
///
///   E_k = -2 when nobody is there, -1 when different groups are, else the group's number                (9)
/// Somebody's group is a number of her own kind: who is in no group is in one like any other.
class Congestion {
 public:
  static constexpr std::int32_t kEmpty = -2;
  static constexpr std::int32_t kMixed = -1;

  /// @param low, high rectangle that holds everybody; who is outside counts to the border  @param side_m > 0
  Congestion(Point low, Point high, double side_m);

  /// O(spaces + people)  @param at where each person is  @param group of each, >= 0
  void fill(std::span<const Point> at, std::span<const std::int32_t> group);
  /// Spaces that a disc touches are mixed: it is in nobody's group.
  void add(const MotionFloor::Disc& disc);

  [[nodiscard]] std::int32_t value(Point at) const { return value_[index(column(at.x), row(at.y))]; }
  /// Whether somebody of another group than `group` is in one of the four spaces nearest to `at`, her own among them.
  /// The own space alone would not do: two fronts that meet on the border of their spaces would never see each other.
  [[nodiscard]] bool meets_others(Point at, std::int32_t group) const;

 private:
  [[nodiscard]] int column(double x) const;
  [[nodiscard]] int row(double y) const;
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  }

  Point low_;
  double side_m_;
  int columns_;
  int rows_;
  std::vector<std::int32_t> value_;
};

}  // namespace footlight::planner::srd
