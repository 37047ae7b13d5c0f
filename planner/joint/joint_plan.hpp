// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/film.hpp"
#include "core/plan.hpp"
#include "planner/formation/placement.hpp"
#include "planner/formation/sampling.hpp"
#include "planner/progress.hpp"
#include "planner/schedule/ways.hpp"

namespace footlight::planner {

/// Instants of a film section between which people can walk two pitches or a little more: whole counts when asked for.
/// The first and the last frame have one. @return ascending, at least two
[[nodiscard]] std::vector<KeyFrame> walking_instants(const Film& film, const FilmTime& time, bool snap_to_count,
                                                     double shortest_s);

struct JointTask {
  const Film* film = nullptr;
  const Ways* ways = nullptr;
  const CellFlags* usable = nullptr;  ///< cells of pictures
  std::vector<CellIndex> reserve;     ///< that can be stood on
  StageToFrame map{};
  double fps = 0;                  ///< frames per second of show
  Instant start;                   ///< of frame 0
  std::vector<KeyFrame> instants;  ///< ascending, at least two; before frame 0 nothing is drawn
  std::size_t people = 0;
  std::vector<CellIndex> first;  ///< where people stand at the first instant; empty: where it is best
  double speed_mps = 0;
  double effort = 1;  ///< how much walking counts against the drawing
  /// Empty, or for each instant the cells of the formation that the director gave; elsewhere it is worth nothing.
  std::vector<std::vector<CellIndex>> given;
};

/// Cells and walks of a film section at once.
struct JointPlan {
  std::vector<std::vector<CellIndex>> at;  ///< for each instant and person; every walk is within speed and way
  /// The walks cost at most so much more than any others under the same limits would, at the weights of the frames
  /// found; 1: one person out of the picture for one interval.
  double gap = 0;
};

/// More cells x instants than this are not planned.
inline constexpr std::size_t kMostNodes = 3'000'000;
/// Whether the film is small enough.
[[nodiscard]] bool can_plan_jointly(const Grid& grid, std::size_t instants);

/// Walks that draw the film: everybody's way is one unit of flow through cells and instants; being on a cell costs what
/// the frames around the instant lose by it, walking its squared length (docs/algorithms/joint.md).
/// @return nothing when stopped. Byte-equal for any number of threads.
[[nodiscard]] std::optional<JointPlan> plan_jointly(const JointTask& task, const Progress& progress);

}  // namespace footlight::planner
