// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/film.hpp"
#include "core/grid.hpp"
#include "core/plan.hpp"

namespace footlight::planner {

/// Sums of a mask over any rectangle in constant time (Crow 1984, "Summed-area tables for texture mapping").
class SummedArea {
 public:
  /// O(pixels) time and memory.
  explicit SummedArea(const Mask& mask);

  /// Picture area, pixels, within [x0, x1) x [y0, y1); corners may lie between pixels and outside of the mask (where
  /// there is no picture). O(1)
  [[nodiscard]] double area(double x0, double y0, double x1, double y1) const;
  /// Picture pixels of the whole mask.
  [[nodiscard]] std::int64_t total() const { return sums_.empty() ? 0 : sums_.back(); }

 private:
  [[nodiscard]] double corner(double x, double y) const;

  int width_ = 0;
  int height_ = 0;
  std::vector<std::uint32_t> sums_;  ///< (width + 1) x (height + 1)
};

/// Share of picture, 0..1, in the square of one cell's area around each cell's centre (r_pa of Li 2020 section III C,
/// measured as rho of Eq. 8 is). The map scales both axes alike. One value a cell. O(cells)
[[nodiscard]] std::vector<double> cell_shares(const SummedArea& picture, const Grid& grid, const StageToFrame& map);

}  // namespace footlight::planner
