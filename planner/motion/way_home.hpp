// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "planner/schedule/ways.hpp"

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
  void find_steps();
  [[nodiscard]] std::vector<float> flood(CellIndex to) const;

  const Ways& ways_;
  std::span<const CellIndex> to_;
  struct Step {
    CellIndex to;
    float length_m = 0;
  };
  std::vector<std::vector<Step>> steps_;      ///< from each cell; empty until somebody asks
  std::vector<std::vector<float>> length_m_;  ///< of each person, to each cell
  std::size_t kept_ = 0;                      ///< numbers
};

}  // namespace footlight::planner
