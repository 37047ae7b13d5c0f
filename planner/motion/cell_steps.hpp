// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "planner/schedule/ways.hpp"

namespace footlight::planner {

/// Which cells can be walked to from which in a straight line, over a floor on which nothing moves: what every search
/// for ways around blocked cells goes by.
class CellSteps {
 public:
  /// @param ways without moving discs; must outlive this  @param reach_m longest step
  /// O(cells x steps), and a look at the blocked cells around for each step near any
  CellSteps(const Ways& ways, double reach_m);

  [[nodiscard]] const Ways& ways() const { return *ways_; }
  [[nodiscard]] std::size_t cells() const { return first_.size() - 1; }
  /// Calls visit(cell, length of the step in m), cells ascending.
  template <class Visit>
  void each_next(std::uint32_t cell, Visit visit) const {
    for (std::uint32_t k = first_[cell]; k < first_[cell + 1]; ++k) visit(next_[k], step_m_[k]);
  }

  /// Steps from every cell to `goal`, m, infinity where there is no way: Dijkstra. O(cells log cells)
  /// @param toward where given: of each cell the next one on that way, `goal` of itself, kNoCell where there is none
  [[nodiscard]] std::vector<float> lengths_to(CellIndex goal, std::vector<std::uint32_t>* toward = nullptr) const;
  /// Cells with equal numbers reach each other; kNoCell where nobody can stand. O(cells x steps)
  [[nodiscard]] std::vector<std::uint32_t> parts() const;

  static constexpr std::uint32_t kNoCell = std::numeric_limits<std::uint32_t>::max();

 private:
  const Ways* ways_;
  std::vector<std::uint32_t> first_;  ///< of each cell in next_; one more than cells
  std::vector<std::uint32_t> next_;
  std::vector<float> step_m_;
};

}  // namespace footlight::planner
