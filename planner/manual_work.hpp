// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/plan.hpp"

namespace footlight::planner {

/// What was done by hand, after Li 2020 section V C ("the proportion of the modified part", 0..1).
struct ManualWork {
  std::int64_t moved = 0;        ///< people moved in key formations
  std::int64_t places = 0;       ///< people x key formations
  std::int64_t pinned = 0;       ///< people put on a cell by name
  std::int64_t assignments = 0;  ///< people x transitions between formations

  /// MWSKF, the manual work on static key formations.
  [[nodiscard]] double formations_share() const;
  /// MWPFT, the manual work on the process of formation transform.
  [[nodiscard]] double transitions_share() const;
};

/// Pins and moves count; lists of cells and groups' regions are material, and nothing is modified by them.
/// O(formations)
[[nodiscard]] ManualWork manual_work(const Plan& plan);

}  // namespace footlight::planner
