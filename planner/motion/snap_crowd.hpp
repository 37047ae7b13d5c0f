// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/index.hpp"
#include "planner/progress.hpp"
#include "planner/schedule/ways.hpp"

namespace footlight::planner {

/// A crowd's way that is to be walked from mark to mark.
struct SnapCrowdTask {
  const Ways* ways = nullptr;
  std::span<const Ways> leg_ways = {};  ///< of each walk to the next instant, while discs move; empty: none does
  std::span<const CellIndex> from;      ///< where each person stands at the first instant; distinct
  std::span<const CellIndex> to;        ///< where each person must stand at the last one; distinct; empty: wherever
  const std::vector<std::vector<Point>>* at = nullptr;  ///< the trajectory: for each instant, of each person
  std::span<const double> at_s;                         ///< the instants, ascending
  std::span<const double> longest_m;                    ///< how far anybody may walk to the next; one less
  /// Walks of people of different kinds keep it, where cells near do; who is of one kind exchanges her target instead.
  double clearance_m = 0;
  std::span<const std::uint32_t> kind = {};  ///< of each person; empty: all are of one
};

/// Marks of a crowd.
struct SnappedCrowd {
  std::vector<std::vector<CellIndex>> cells;  ///< for each instant, of each person; distinct at every instant
  double mean_m = 0;                          ///< distance of marks from the trajectory, over people and instants
  double max_m = 0;
  std::size_t farthest_instant = 0;  ///< of max_m
  /// Somebody whom a moving obstacle would run over, since there is no free cell that she can reach in time.
  struct Caught {
    std::size_t instant = 0;
    Point at;
  };
  std::optional<Caught> caught;  ///< `cells` ends before that instant then
};

/// Puts everybody, at each instant, on a cell of her own near where the trajectory has her: the least sum of squared
/// distances over the cells around, exact (`cheapest_places`), among those that can be stood on, that can be walked to
/// straight from the mark before, and from which the place at the end can still be reached. Who cannot keep up goes
/// toward the trajectory as far as walking allows, around what is blocked. Everybody can always stay where she is,
/// so there always is an answer, unless a moving obstacle comes that way. The last marks are the places at the end,
/// whether or not they can be reached: what cannot is for the chain to refuse.
/// @return nothing when stopped. The result does not depend on the order of people.
/// O(instants x people x cells near); on a floor with blocked cells and `to` at most people x cells log cells more
[[nodiscard]] std::optional<SnappedCrowd> snap_crowd(const SnapCrowdTask& task, const Progress& progress);

/// The fastest that somebody can go in every direction who stands on a cell every `walk_m` of walking, as share of how
/// fast she walks: 0 where no cell is that near. Half the width of the convex hull of the cells in reach.
[[nodiscard]] double followed_share(const Grid& grid, double walk_m);

}  // namespace footlight::planner
