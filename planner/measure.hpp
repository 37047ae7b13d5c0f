// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/film.hpp"
#include "core/plan.hpp"
#include "planner/crowd_measure.hpp"
#include "planner/progress.hpp"

namespace footlight::planner {

/// How well and how calmly a section or a show is drawn. Shares 0..1.
struct Measures {
  int frames = 0;                   ///< in which somebody was in the picture; 0: the thetas of the picture are absent
  std::optional<double> theta_dev;  ///< Li 2020 Eq. 8, mean over frames: who is outside of the picture
  std::optional<double> theta_dev_var;  ///< population variance over frames
  std::optional<double> theta_miss;     ///< share of the picture that nobody covers, mean over frames with a picture
  std::optional<double> theta_iou;      ///< 1 - (covered and picture) / (covered or picture), mean over frames
  double min_clearance_m = 0;           ///< infinity for fewer than two people
  PerformerIndex closest_a;             ///< who are nearest to each other, and when
  PerformerIndex closest_b;
  Instant closest_at;
  std::uint64_t too_close = 0;  ///< pairs and stretches below their clearance, as Verdict::too_close
  double max_speed_m_s = 0;
  double total_distance_m = 0;    ///< walked by everybody together
  double longest_distance_m = 0;  ///< of one person
  double median_distance_m = 0;
  double distance_gini = 0;  ///< Gini coefficient of the people's distances: 0 all alike, towards 1 one walks for all
  /// Times that somebody goes on in a direction more than 30 degrees off the one before, waiting between or not; of
  /// everybody together.
  std::uint64_t direction_changes = 0;
  std::uint64_t arrivals = 0;   ///< marks on another cell than the mark before: what people must learn
  double marks_per_minute = 0;  ///< arrivals of one performer, mean over people and time
  int formations = 0;
  std::optional<CrowdFigures> crowd;  ///< Xu 2015, every half second; absent: nobody walks, or not measured
};

struct ShowMeasures {
  InformationClasses crowd_classes;  ///< R and K of `crowd`
  Measures show;                     ///< thetas: over the frames of all sections, so that each frame weighs the same
  std::vector<Measures> sections;
};

/// Measures a plan, valid or not, by its marks and its films.
///
/// A frame f of the film's file is judged at start + (f - first_frame) / show_fps where that lies in the section; an
/// image is judged once, at the section's start. The judged square has one cell's area and stands, parallel to the
/// frame, around where the performer is at that instant; rho (Li 2020, Eq. 8) is the share of picture in it. People who
/// stand on a reserve cell of the section at both ends of the stretch are not in the picture. A walk from one section
/// into the next counts to the later one.
///
/// @param films one for each section, as for plan_show; absent ones are not judged
/// @param progress tells the share of frames as stage "measure"; when stopped, what is returned is worthless
/// Complexity: O(frames x (pixels + people log marks)) on all cores; the result does not depend on how many.
/// Source: Li, Huang, Liu, Ding 2020, Eq. 8, in the definition of check/theta_dev.py. Thread: reentrant.
[[nodiscard]] ShowMeasures measure(const Plan& plan, const std::vector<std::optional<Film>>& films,
                                   const Progress& progress = {});

/// What `measure` says without films and how the crowd moves, of a plan whose transitions have just been proved: their
/// facts are taken at their word, and nothing is judged again. @param plan valid, as `plan_show` returns it. O(marks)
[[nodiscard]] ShowMeasures measure_walks(const Plan& plan);

/// Tolerated lag of each transition of a plan, s, at most 2 s, measured anew: a plan from a file may say anything.
/// @param progress tells the share of transitions as stage "lag"
/// @return as long as plan.transitions; worthless when stopped. On all cores. Thread: reentrant.
[[nodiscard]] std::vector<double> measure_lag(const Plan& plan, const Progress& progress = {});

}  // namespace footlight::planner
