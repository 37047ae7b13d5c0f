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
    const double most = radius_m * radius_m;
    visit_rows(at, radius_m, [&](std::uint32_t begin, std::uint32_t end) {
      for (std::uint32_t k = begin; k < end; ++k) {
        const double squared = squared_length(where_[k] - at);
        if (squared <= most) visit(who_[k], squared);
      }
    });
  }

  /// People bin by bin, in each by number: neighbours stand side by side in this list, and so does what a step knows of
  /// them if it is kept in this order.
  /// @{
  [[nodiscard]] std::span<const std::uint32_t> order() const { return who_; }
  [[nodiscard]] std::span<const Point> places() const { return where_; }
  /// @}
  /// Calls visit(begin, end) for stretches of `order()` that have everybody no farther than `radius_m` from `at`, and
  /// others; in ascending order. O(rows of bins touched)
  template <class Visit>
  void visit_rows(Point at, double radius_m, Visit visit) const {
    const std::size_t first_x = bin(at.x - radius_m - low_.x, columns_);
    const std::size_t last_x = bin(at.x + radius_m - low_.x, columns_);
    const std::size_t first_y = bin(at.y - radius_m - low_.y, rows_);
    const std::size_t last_y = bin(at.y + radius_m - low_.y, rows_);
    for (std::size_t y = first_y; y <= last_y; ++y) {
      visit(start_[y * columns_ + first_x], start_[y * columns_ + last_x + 1]);
    }
  }

 private:
  [[nodiscard]] std::size_t bin(double offset_m, std::size_t bins) const {
    return static_cast<std::size_t>(std::clamp(offset_m * per_bin_m_, 0.0, static_cast<double>(bins - 1)));
  }

  Point low_;
  double per_bin_m_ = 1;
  std::size_t columns_ = 1;
  std::size_t rows_ = 1;
  std::vector<std::uint32_t> start_;  ///< of each bin in who_, row by row; two more than bins
  std::vector<std::uint32_t> who_;
  std::vector<Point> where_;  ///< of who_, side by side in memory
  std::vector<std::uint32_t> bin_of_;
};

}  // namespace footlight::planner
