// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "app/import/drone_zip.hpp"
#include "app/import/fitting_grid.hpp"
#include "core/plan.hpp"
#include "core/result.hpp"
#include "core/tempo_map.hpp"

namespace footlight::app {

/// How tracks become formations.
struct WalkChoice {
  TempoMap tempo;
  bool between_counts = false;  ///< formations may be between whole counts
  GridChoice grid;
};

/// The formations of tracks.
struct DroneWalks {
  Imported imported;
  FittingGrid grid;
};

/// The instants at which everybody is on a cell and somebody starts, stops or turns, or everybody has a line:
/// formations. Lines on a straight way of constant speed between two of them, as programs write that sample, add
/// nothing: where any line is on no cell, only starts, stops and turns count. Where somebody turns while others walk
/// there is no formation; the planner finds such ways anew. Errors: tracks of unequal length, a turn on no cell, two
/// people on one cell, formations between whole counts unless `between_counts`. O(all lines + instants x people)
[[nodiscard]] Result<DroneWalks> drone_walks(const std::vector<DroneTrack>& tracks, const WalkChoice& choice);

/// Largest distance of anybody's way in the plan from the tracks, and whose. @param order tracks in the plan's order
struct WayDifference {
  double largest_m = 0;
  std::size_t person = 0;
  Instant when;
  std::size_t people = 0;  ///< who is farther than kRounding_m from the track at some time
};
[[nodiscard]] WayDifference difference_of(const Plan& plan, const std::vector<DroneTrack>& tracks, Point shift);

}  // namespace footlight::app
