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
  std::vector<KeyFrame> instants;  ///< ascending, at least two
  std::vector<CellIndex> first;    ///< where people stand at the first instant; distinct
  double speed_mps = 0;
  /// Where people stand at each instant in a plan that can be walked, or empty. With a reserve it says who sets out
  /// when: further ahead than anybody looks here.
  std::vector<std::vector<CellIndex>> guide;
};

/// Cells and walks of a film section at once.
struct JointPlan {
  std::vector<std::vector<CellIndex>> at;  ///< for each instant and person; every walk is within speed and way
};

/// Walks that draw the film: everybody's way is one unit of flow through cells and instants, and a walk costs what the
/// frames that are shown meanwhile lose or gain by it, and its squared length. Each stretch of a few intervals is
/// solved exactly (docs/algorithms/joint.md).
/// @return nothing when stopped, or when there are more than 60 million walks to weigh. Byte-equal for any number of
/// threads.
[[nodiscard]] std::optional<JointPlan> plan_jointly(const JointTask& task, const Progress& progress);

}  // namespace footlight::planner
