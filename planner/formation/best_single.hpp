// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/film.hpp"
#include "core/plan.hpp"
#include "planner/formation/placement.hpp"

namespace footlight::planner {

/// How well people who need not walk draw one frame.
struct SingleBest {
  int people = 0;      ///< in the picture
  double covered = 0;  ///< picture in their cells, cells
  double area = 0;     ///< of the picture, cells

  [[nodiscard]] double dev() const { return people > 0 ? 1 - covered / people : 0; }
  [[nodiscard]] double miss() const { return area > 0 ? 1 - covered / area : 0; }
  [[nodiscard]] double iou() const {
    const double either = area + people - covered;
    return either > 0 ? 1 - covered / either : 0;
  }
};

struct SingleTask {
  const std::vector<double>* shares = nullptr;  ///< picture in each cell
  const CellFlags* usable = nullptr;
  double area = 0;  ///< of the picture, in cells' areas, on the floor or not
  int least = 0;    ///< people whom the reserve cannot hold
  int most = 0;
};

/// The number of people in [least, most], on the cells with the most picture, with the least theta_dev + theta_iou of
/// the frame alone. O(cells log cells)
[[nodiscard]] SingleBest best_single(const SingleTask& task);

/// Bounds that walking cannot beat by the same cells: means over the frames of a film that `measure` judges.
struct SingleFigures {
  double theta_dev = 0;
  double theta_miss = 0;
  double theta_iou = 0;
};

/// @param plan with a film placement in that section  @return nothing where the section has no film
/// O(frames x (pixels + cells log cells)), all cores
[[nodiscard]] std::optional<SingleFigures> best_of_frames(const Plan& plan, SectionIndex section, const Film& film);

}  // namespace footlight::planner
