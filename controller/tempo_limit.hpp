// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "controller/bus_budget.hpp"
#include "controller/cue_list.hpp"
#include "core/plan.hpp"

namespace footlight::controller {

/// How fast a cue may be played, in percent of the written tempo.
struct TempoLimit {
  int percent = 200;
  std::string because;  ///< "performer 8 walks at 3.39 of 4 m/s at count 17"; empty: nothing limits it below 200 %
};

/// For each cue the tempo at which somebody would walk faster than the limit that the plan was proved for, or a bus
/// could no longer carry a switch in time with its reserve, or a lamp would light up more than three times in a second
/// (flash_rate.hpp): at most kFastest_percent, never below 100. Ways and
/// clearances do not depend on the tempo; how late anybody may be does, as 1 / tempo.
/// @param needs as bus_needs of the same schedule says
/// Complexity: O(marks + needs)
[[nodiscard]] std::vector<TempoLimit> tempo_limits(const Plan& plan, const TempoMap& tempo,
                                                   const std::vector<CuePlay>& plays, const CueSchedule& schedule,
                                                   const std::vector<BusNeed>& needs, const Rig& rig);

}  // namespace footlight::controller
