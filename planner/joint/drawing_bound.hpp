// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "core/film.hpp"
#include "core/plan.hpp"
#include "planner/progress.hpp"

namespace footlight::planner {

/// theta_iou of the frames at the formations of a film, when everybody stands on a cell; means. What is between them is
/// not in it.
struct DrawingBound {
  std::size_t instants = 0;
  double of_plan = 0;
  double least = 0;  ///< no walks within the limit of speed, with everybody on a cell at these instants, are below
  double nobody_walks = 0;  ///< the best formation of each single frame
};

/// How well a film can be drawn at the instants of a plan by people who walk no faster than the section allows, whoever
/// walks where: blocked cells on the way, clearance and slower people only make it worse. A proof and no estimate: a
/// plane below each frame's figure makes the sum of all frames the cost of a flow through cells and instants, and
/// prices of cells bound that from below; the planes are improved `rounds` times (docs/algorithms/joint.md).
/// @return nothing where the section has no film or fewer than two formations, where cells times formations are too
/// many to plan jointly, or when stopped. Deterministic. Each round takes about as long as planning the film.
[[nodiscard]] std::optional<DrawingBound> bound_drawing(const Plan& plan, SectionIndex section, const Film& film,
                                                        int rounds, const Progress& progress = {});

}  // namespace footlight::planner
