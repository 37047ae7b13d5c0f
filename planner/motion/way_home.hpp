// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "planner/motion/cell_steps.hpp"

namespace footlight::planner {

/// How long the way is from a cell to each person's place, over neighbouring cells around what is blocked. Each
/// person's is found when it is asked for first, and kept while there is memory for it.
class WayHome {
 public:
  /// @param to place of each person; must live as long as this
  WayHome(const Ways& ways, std::span<const CellIndex> to);

  /// At least as long as the shortest way there is; infinity where none is. O(1), the first of a person
  /// O(cells log cells)
  [[nodiscard]] double length_m(std::uint32_t person, CellIndex from);

 private:
  const Ways& ways_;
  std::span<const CellIndex> to_;
  std::optional<CellSteps> steps_;            ///< nothing until somebody asks
  std::vector<std::vector<float>> length_m_;  ///< of each person, to each cell
  std::size_t kept_ = 0;                      ///< numbers
};

}  // namespace footlight::planner
