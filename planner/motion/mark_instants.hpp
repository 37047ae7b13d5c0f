// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/stage.hpp"
#include "core/tempo_map.hpp"
#include "planner/schedule/ways.hpp"

namespace footlight::planner {

/// What decides when people have marks on a way that a model leads them.
struct MarkTask {
  const TempoMap* tempo = nullptr;
  const Grid* grid = nullptr;
  WalkKind walk = WalkKind::straight;
  double start_count = 1;
  double duration_counts = 1;            ///< > 0
  double speed_mps = 1;                  ///< fastest walk
  std::optional<double> spacing_counts;  ///< nothing: as often as people can follow a way in every direction
};

/// The instants at which people have marks.
struct MarkInstants {
  std::vector<double> count;      ///< ascending, from the section's start to start + duration
  std::vector<double> at_s;       ///< of each, from the section's start
  std::vector<double> longest_m;  ///< how far anybody may walk to the next; one less
  double spacing_counts = 1;
  double followed_mps = 0;  ///< the fastest that people can go in every direction from mark to mark (`followed_share`)
  std::vector<char> spare;  ///< one flag an instant: only there for who could not be followed without it

  /// Leaves out the instants that are spare where everybody's way between their neighbours is straight, within a pitch,
  /// and free.  @param at in and out: positions at each instant
  void thin(std::vector<std::vector<Point>>& at, const Ways& ways);
};

/// Of the speed that people on cells can keep up in every direction (`followed_mps`), so much is a model's: the rest is
/// for the detours that they make for each other.
inline constexpr double kModelShare = 0.95;

/// The shortest time between two marks in which somebody comes from a cell to the next, counts.
[[nodiscard]] double least_mark_counts(const MarkTask& task);

/// Marks on multiples of the spacing, the last at the end: an interval that would be shorter is joined to the one
/// before. With a given spacing also halves, quarters ... of it in which people can still walk two pitches, all spare.
[[nodiscard]] MarkInstants mark_instants(const MarkTask& task);

}  // namespace footlight::planner
