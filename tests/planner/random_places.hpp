// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "planner/schedule/ways.hpp"
#include "tests/support/plan_builder.hpp"

namespace footlight::planner {

/// Where somebody can stand, ascending.
[[nodiscard]] inline std::vector<CellIndex> standable_cells(const Ways& ways) {
  std::vector<CellIndex> cells;
  for (int i = 0; i < ways.grid().size(); ++i) {
    if (ways.can_stand(CellIndex::of(i))) cells.push_back(CellIndex::of(i));
  }
  return cells;
}

/// `people` different cells on which somebody can stand.
[[nodiscard]] inline std::vector<CellIndex> random_places(const Ways& ways, std::size_t people, Rng& rng) {
  return tests::random_cells(standable_cells(ways), people, rng);
}

/// Of everybody one of at most as many kinds as there are people.
[[nodiscard]] inline std::vector<std::uint32_t> random_kinds(std::size_t people, Rng& rng) {
  std::vector<std::uint32_t> kind(people);
  const std::uint64_t kinds = 1 + rng.below(people);
  for (std::uint32_t& one : kind) one = static_cast<std::uint32_t>(rng.below(kinds));
  return kind;
}

}  // namespace footlight::planner
