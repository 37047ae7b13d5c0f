// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/load.hpp"
#include "app/show_series.hpp"
#include "app/supply_figures.hpp"
#include "controller/dark_nodes.hpp"
#include "core/diagnostic.hpp"
#include "core/plan.hpp"
#include "core/rig.hpp"
#include "core/show.hpp"
#include "planner/crowd_measure.hpp"
#include "planner/measure.hpp"

namespace footlight::app {

/// The hardest switch of one bus.
struct BusLoad {
  std::string bus;
  double busiest = 0;   ///< share of the time there is, the reserve taken off
  double needed_s = 0;  ///< at that switch
  double allowed_s = 0;
  int changed = 0;  ///< nodes
  std::string cause;
};

/// Everything that a report shows.
struct ReportFacts {
  planner::ShowMeasures measures;
  std::vector<double> lag_s;
  DrawingSeries drawing;
  ClearanceSeries clearance;
  planner::CrowdSeries crowd;
  WayFigures ways;
  std::vector<BusLoad> buses;
  std::string buses_missing;  ///< why there are no bus loads, nor those of supplies
  std::vector<SupplyFigures> supplies;
  std::vector<controller::DarkUnit> dark;
  std::vector<Diagnostic> warnings;
};

/// One HTML page that needs nothing else: styles and pictures are inside.
[[nodiscard]] std::string report_html(const Plan& plan, const Show& show, const Films& films, const ReportFacts& facts);

}  // namespace footlight::app
