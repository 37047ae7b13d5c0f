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
/// One for each performer.
struct WayFigures {
  std::vector<double> walked_m;
  std::vector<double> fastest_mps;
};

/// Frames that fall into their sections, in the order of time; an image at the begin and end of its section.
[[nodiscard]] DrawingSeries drawing_series(const Plan& plan, const Films& films);
/// Exact within each stretch of `stretch_s`.
[[nodiscard]] ClearanceSeries clearance_series(const Plan& plan, double stretch_s);
[[nodiscard]] WayFigures way_figures(const Plan& plan);

}  // namespace footlight::app
