// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "app/load.hpp"
#include "core/plan.hpp"

namespace footlight::app {

/// What a report shows over time. All lists of one struct have one length; times are those of the show, s.
struct DrawingSeries {
  std::vector<double> time_s;
  std::vector<double> dev;   ///< Li 2020 Eq. 8 of one frame; not a number when nobody is in the picture
  std::vector<double> miss;  ///< share of the picture that nobody covers
};
struct ClearanceSeries {
  std::vector<double> time_s;  ///< begin of each stretch
  std::vector<double> least_m;
  std::vector<PerformerIndex> a;
  std::vector<PerformerIndex> b;
  std::vector<double> at_s;
};
/// How calmly a crowd moves: Xu et al. 2015, Eq. 11-17 and 24-26.
struct CrowdSeries {
  std::vector<double> time_s;
  std::vector<double> information;  ///< I_d, bits, between place and direction of those who walk; not a number: nobody
  std::vector<double> pace_information;  ///< I_v, bits, between place and speed of those who walk
  std::vector<double> sigma_nearest_m;   ///< sigma_min_dis, over everybody
  std::vector<double> sigma_effort_m;    ///< sigma_curr_eft: way since the formation before, over everybody
};
/// One for each performer.
struct WayFigures {
  std::vector<double> walked_m;
  std::vector<double> fastest_mps;
};

/// Frames that fall into their sections, in the order of time; an image at the begin and end of its section.
[[nodiscard]] DrawingSeries drawing_series(const Plan& plan, const Films& films);
/// Exact within each stretch of `stretch_s`.
[[nodiscard]] ClearanceSeries clearance_series(const Plan& plan, double stretch_s);
/// Every `step_s`: the floor in ten bins across its longer side, directions in eight sectors,
/// speeds in eight classes up to the fastest walk of the show.
[[nodiscard]] CrowdSeries crowd_series(const Plan& plan, double step_s);
[[nodiscard]] WayFigures way_figures(const Plan& plan);

/// Eq. 11 with logarithms of base 2, of pairs of small whole numbers. 0 for none. @param pairs both below 4096
[[nodiscard]] double mutual_information_bits(const std::vector<std::pair<int, int>>& pairs);

}  // namespace footlight::app
