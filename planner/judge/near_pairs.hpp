// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/grid.hpp"

namespace footlight::planner::judge {

/// A disc that moves straight and evenly from one place to another; a negative radius: nobody.
struct MovingDisc {
  Point start;
  Point end;
  double radius_m = 0;
};

/// Finds the pairs that touch among many discs that move at the same time. A binary tree, split at the median of the
/// coordinate (of the starts or of the ends) that is most spread: two of its parts are looked into only where the boxes
/// around their starts and ends, moved along, overlap at one moment. Keeps its memory from call to call.
class NearPairs {
 public:
  using Pair = std::pair<std::uint32_t, std::uint32_t>;

  /// @return every pair (i, j), i < j, of discs that touch or overlap at one moment, once, and perhaps some that just
  /// do not (by a millionth of a metre). Valid until the next call. O(n log n + pairs) for discs of like radius.
  /// Deterministic, in no particular order.
  std::span<const Pair> find(std::span<const MovingDisc> discs);

 private:
  /// Four columns: start x, y, end x, y.
  static constexpr int kSides = 4;
  struct Part {
    double low[kSides];
    double high[kSides];
    double radius_m;  ///< the largest in it
    std::uint32_t begin;
    std::uint32_t end;
    std::uint32_t second;  ///< the first half follows directly; 0: not divided
  };
  void divide(std::uint32_t begin, std::uint32_t end);
  void within(std::uint32_t part);
  void between(std::uint32_t one, std::uint32_t other);
  void members(const Part& one, const Part& other);

  struct Member {
    double side[kSides];
    double radius_m;
    std::uint32_t disc;
  };
  std::vector<Member> members_;
  std::vector<double> column_[kSides + 1];  ///< of the members' sides and radii
  std::vector<Part> parts_;
  std::vector<Pair> pairs_;
};

}  // namespace footlight::planner::judge
