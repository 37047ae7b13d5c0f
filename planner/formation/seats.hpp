// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "planner/formation/placement.hpp"
#include "planner/schedule/places.hpp"

namespace footlight::planner {

/// Cells for the drawings of one formation: each drawing's points get the cells that are nearest in the sum of squares,
/// no cell twice, those of drawings before included.
class Seats {
 public:
  /// @param people of all drawings together  @param usable cells; both must outlive this
  Seats(const Grid& grid, const CellFlags& usable, std::size_t people);

  /// @param only cells that it may take, one flag a cell; empty: any usable ones
  /// @return false: some have no cell within reach beside all others
  [[nodiscard]] bool add(const std::vector<Point>& points, const CellFlags& only = {});
  /// Of every point that was added, in order. After the last `add`, none of which failed.
  [[nodiscard]] std::vector<CellIndex> cells() const;

  /// Nobody is sent farther from where the drawing wants somebody, pitches; four times as far among cells that are
  /// given.
  static constexpr double kReach = 6.4;

 private:
  /// @return false: somebody has no choice
  bool choose(const std::vector<Point>& points, const CellFlags& only, double reach);

  const Grid& grid_;
  const CellFlags& usable_;
  Places places_;
  std::uint32_t seated_ = 0;
};

}  // namespace footlight::planner
