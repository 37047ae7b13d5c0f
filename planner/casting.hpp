// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/result.hpp"
#include "planner/schedule/cast_tracks.hpp"

namespace footlight::planner {

/// Who may take whose place, as the show asks for it: lists of cells by name or by group, groups bound to regions,
/// people pinned to cells, groups that do not exchange.
/// @return ErrorKind::input, positioned, where two of these contradict each other. O(stations x people x groups)
[[nodiscard]] Result<Casting> casting_of(const Show& show, const std::vector<Station>& stations);

/// Makes people whose radii ask for more than the clearance kinds of their own, by radius, so that their walks can keep
/// the distances that they need and everybody else's need not.
void keep_apart_by_radius(const Show& show, Casting& casting);

/// For each group whether any formation, or `exchange: false`, keeps others off its places and its people off others'.
[[nodiscard]] std::vector<char> bound_groups(const Show& show);

/// A formation whose places are divided among groups.
struct RegionTask {
  const Show* show = nullptr;
  const std::vector<footlight::Region>* regions = nullptr;
  const std::vector<CellIndex>* cells = nullptr;  ///< of the formation
  std::vector<char> taken;  ///< one flag a cell: pinned, nobody's to give; its person is not among `people`
  std::vector<int> people;  ///< of each group with regions, by its number, and of all others at the end
};

/// Each group takes the places in its own regions, nearest to their middle first; where these are too few the nearest
/// ones beside them in nobody's region. Whoever is in no such group takes what is left there, then what is left in
/// regions; what remains goes to the groups by distance.
/// @return for each cell the number of its group, the number of groups for the others, kOpenPlace where the cell is
/// taken or of the reserve. O(cells x groups, sorted)
[[nodiscard]] std::vector<std::uint32_t> divide_by_regions(const RegionTask& task);

}  // namespace footlight::planner
