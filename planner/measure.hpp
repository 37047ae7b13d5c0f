// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/film.hpp"
#include "core/plan.hpp"
#include "planner/progress.hpp"

namespace footlight::planner {

/// How well and how calmly a section or a show is drawn. Shares 0..1.
struct Measures {
  int frames = 0;                       ///< looked at; 0: no picture, the thetas are absent
  std::optional<double> theta_dev;      ///< Li 2020 Eq. 8, mean over frames: who is outside of the picture
  std::optional<double> theta_dev_var;  ///< variance over frames
  std::optional<double> theta_miss;     ///< share of the picture that nobody covers
  std::optional<double> theta_iou;      ///< 1 - (covered and picture) / (covered or picture)
  double min_clearance_m = 0;
  std::uint64_t too_close = 0;
  double max_speed_m_s = 0;
  double total_distance_m = 0;
  double longest_distance_m = 0;  ///< of one person
  int formations = 0;
};

struct ShowMeasures {
  Measures show;  ///< thetas: mean weighted by frames
  std::vector<Measures> sections;
};

/// @param films as for plan_show. The judged square has one cell's area and stands around where the performer is at
/// that instant; people who stand on a reserve cell at both ends of the stretch are not in the picture.
[[nodiscard]] ShowMeasures measure(const Plan& plan, const std::vector<std::optional<Film>>& films,
                                   const Progress& progress = {});

}  // namespace footlight::planner
