// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/plan.hpp"
#include "planner/mutual_information.hpp"

namespace footlight::planner {

/// How calmly a crowd moves at one instant: Xu et al. 2015, Eq. 11 to 17 and 24 to 26. Not a number: it does not exist.
struct CrowdInstant {
  PlaceInformation information{};  ///< I_d, I_v and N, of those who walk
  /// The same with the ways of walking dealt out among those who walk at random, mean of four deals: what chance alone
  /// gives. Few people in many classes have much of it.
  double shuffled_direction_bits = 0;
  double shuffled_speed_bits = 0;
  double sigma_nearest_m = 0;  ///< sigma_min_dis of Eq. 24, over everybody: of the distance to whoever is nearest
  double sigma_effort_m = 0;   ///< sigma_curr_eft of Eq. 26, over everybody: of how far people are from their source
};

/// @param source where everybody was when the transform began  @param deal number of the random deals
[[nodiscard]] CrowdInstant crowd_at(std::span<const Point> position, std::span<const Point> velocity,
                                    std::span<const Point> source, const InformationClasses& classes,
                                    std::uint64_t deal);

/// Ten bins across the longer side of the floor, eight sectors, eight classes of speed up to `fastest_mps`.
[[nodiscard]] InformationClasses classes_of(const Grid& grid, double fastest_mps);
/// The fastest walk of a plan, m/s.
[[nodiscard]] double fastest_walk_mps(const Plan& plan);

struct CrowdSeries {
  InformationClasses classes;
  std::vector<double> time_s;
  std::vector<CrowdInstant> at;  ///< one for each of time_s
};

/// From the first section's start to the last one's end, every `step_s`. An instant at a mark looks at the walk that
/// begins there. A source is the key formation before, or where a section begins that has no key formation.
/// O(instants people), in parallel. Thread: reentrant.
[[nodiscard]] CrowdSeries crowd_series(const Plan& plan, double step_s);

/// Means over instants at which somebody walks; absent: nobody ever does.
struct CrowdFigures {
  std::size_t instants = 0;
  double moving = 0;  ///< N
  double direction_bits = 0;
  double speed_bits = 0;
  double shuffled_direction_bits = 0;
  double shuffled_speed_bits = 0;
  double sigma_nearest_m = 0;
  double sigma_effort_m = 0;
};
/// Over instants in [from_s, until_s).
[[nodiscard]] std::optional<CrowdFigures> crowd_figures(const CrowdSeries& series, double from_s, double until_s);

}  // namespace footlight::planner
