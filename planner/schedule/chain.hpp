// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "planner/plan_section.hpp"
#include "planner/schedule/walks.hpp"

namespace footlight::planner {

/// All formations of a show, one after the other.
struct ChainTask {
  const Show* show = nullptr;
  const Ways* ways = nullptr;
  const std::vector<Station>* stations = nullptr;
  double clearance_m = 0.5;  ///< that holds for every two people
};

/// An instant at which everybody stands on a cell.
struct Stop {
  double count = 1;
  Instant arrive;
  Instant depart;
  std::optional<std::size_t> station;  ///< absent: on the way around blocked cells
  SectionIndex section;                ///< whose limits hold on the way here
  std::vector<CellIndex> own;          ///< ideal cell of each slot; empty on the way
  std::vector<CellIndex> cells;        ///< of each slot, as it can be walked; distinct
  int given_way = 0;                   ///< slots in the picture whose cell is not the own one
};

/// Who goes where: position 0.. in `cells` of one stop -> position in `cells` of the next.
struct Chain {
  std::vector<Stop> stops;
  std::vector<Leg> legs;          ///< one less than stops
  std::vector<double> longest_m;  ///< for each leg, how far anybody may walk
};

/// From formations to walks: ideal pairings of neighbours (parallel), slots through the show, pace, snap, then for each
/// interval the final pairing (parallel). Targets of a pinned station are exchanged like any other; `plan_show` puts
/// the named people on them.
/// @return nothing when stopped. Byte-equal for any number of threads.
[[nodiscard]] std::optional<Chain> walk_through(const ChainTask& task, const Progress& progress);

}  // namespace footlight::planner
