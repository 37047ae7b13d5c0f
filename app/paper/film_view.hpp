// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/film.hpp"
#include "core/grid.hpp"
#include "core/plan.hpp"

namespace footlight::app {

/// What a section's film shows on the floor. Borrows everything.
class FilmView {
 public:
  /// @param film of the section, or null: shows nothing
  FilmView(const Plan& plan, SectionIndex section, const Film* film);

  /// The picture at an instant of the section, which holds its last one; null without a film.
  [[nodiscard]] const Mask* at(Instant instant) const;
  /// The picture of a frame of the file; null when there is no such frame.
  [[nodiscard]] const Mask* of_frame(int frame) const;
  /// Whether the picture shows something on some part of the square of one pitch around a point of the floor.
  [[nodiscard]] bool shows(const Mask& picture, Point at) const;
  [[nodiscard]] const StageToFrame& placement() const { return section_.film->stage_to_frame; }

 private:
  const PlanSection& section_;
  const Film* film_;
  double pitch_m_;
};

}  // namespace footlight::app
