// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/grid.hpp"

namespace footlight::planner {

/// People sorted into square bins, to find who is near whom. Made anew for each generation; keeps its memory.
///
/// Source: counting sort into a uniform grid (Green, "Particle simulation using CUDA", 2010). Space stays linear in the
/// people: bins grow where the crowd is spread wide.
class Neighbours {
 public:
  /// O(people + bins)  @param bin_m side of a bin, > 0; best the radius that is asked for most
  void sort(std::span<const Point> people, double bin_m);

  /// Calls visit(i, squared distance) for everybody no farther than `radius_m` from `at`, oneself included, in an order
  /// that depends on positions and numbers alone: by bin, then by number. O(people in the bins touched)
  template <class Visit>
  void visit(Point at, double radius_m, Visit visit) const {
    const int first_x = bin(at.x - radius_m - low_.x, columns_);
    const int last_x = bin(at.x + radius_m - low_.x, columns_);
    const int first_y = bin(at.y - radius_m - low_.y, rows_);
    const int last_y = bin(at.y + radius_m - low_.y, rows_);
    const double most = radius_m * radius_m;
    for (int y = first_y; y <= last_y; ++y) {
      const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_);
      const std::uint32_t begin = start_[row + static_cast<std::size_t>(first_x)];
      const std::uint32_t end = start_[row + static_cast<std::size_t>(last_x) + 1];
      for (std::uint32_t k = begin; k < end; ++k) {
        const double squared = squared_length(where_[k] - at);
        if (squared <= most) visit(who_[k], squared);
      }
    }
  }

 private:
  [[nodiscard]] int bin(double offset_m, int bins) const {
    return std::clamp(static_cast<int>(offset_m / bin_m_), 0, bins - 1);
  }

  Point low_;
  double bin_m_ = 1;
  int columns_ = 1;
  int rows_ = 1;
  std::vector<std::uint32_t> start_;  ///< of each bin in who_, row by row; one more than bins
  std::vector<std::uint32_t> who_;
  std::vector<Point> where_;  ///< of who_, side by side in memory
  std::vector<std::uint32_t> bin_of_;
};

}  // namespace footlight::planner
