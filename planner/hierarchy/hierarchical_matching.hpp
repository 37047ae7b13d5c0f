// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/grid.hpp"
#include "core/show.hpp"

namespace footlight::planner {

/// Who goes where between two formations, Li 2020 Algorithms 1-2: both are divided into regions, people are carried
/// from regions to regions, the parts are divided again with smaller regions, and in the finest parts persons are
/// matched exactly. `options.layers` counts the persons' level: 1 matches everybody at once, 2 has one division into
/// regions of `options.region_size`, each layer more divides those again, into regions a quarter as large (T_n and
/// T_v). `options.cost` is that between anchors, between people and anchors, and between people and cells.
///
/// @param sources, targets  the same number of distinct cells
/// @return position in `targets` for each source, a bijection. Conflicts at the borders of the parts are
/// exchanged away. Deterministic. Thread: reentrant.
[[nodiscard]] std::vector<std::uint32_t> match_hierarchically(const Grid& grid, std::span<const CellIndex> sources,
                                                              std::span<const CellIndex> targets,
                                                              const PlannerOptions& options);

/// The ideal pairing that a section asks for: `match_hierarchically`, or everybody at once by the chosen cost.
[[nodiscard]] std::vector<std::uint32_t> pair_formations(const Grid& grid, std::span<const CellIndex> sources,
                                                         std::span<const CellIndex> targets,
                                                         const PlannerOptions& options);

}  // namespace footlight::planner
