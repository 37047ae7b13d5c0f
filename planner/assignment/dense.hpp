// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "planner/assignment/arc_rows.hpp"

namespace footlight::planner::assignment {

/// A full table of costs, row by row of the sources. Rows are filled up with infinity to a multiple of kFan.
class CostTable {
 public:
  explicit CostTable(std::uint32_t size);
  [[nodiscard]] std::uint32_t size() const { return size_; }
  [[nodiscard]] std::uint32_t width() const { return width_; }
  [[nodiscard]] double* row(std::uint32_t source) { return &costs_[std::size_t{source} * width_]; }
  [[nodiscard]] const double* row(std::uint32_t source) const { return &costs_[std::size_t{source} * width_]; }

 private:
  std::uint32_t size_;
  std::uint32_t width_;
  std::vector<double> costs_;
};

/// The cheapest perfect matching of a full table of costs, and its dual solution, by shortest augmenting paths after a
/// column reduction (Jonker and Volgenant 1987, without their reductions of rows, which make prices too uneven to start
/// an auction from). The right tool below a hundred. O(size^3)
///
/// @param costs whole numbers, 0 <= cost, size x cost < 2^50, so that doubles hold every sum exactly; infinity:
/// forbidden
/// @return source_of is kNobody somewhere when there is no matching without a forbidden pair
[[nodiscard]] Matching match_dense(const CostTable& costs);

}  // namespace footlight::planner::assignment
