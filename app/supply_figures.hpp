// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "controller/cue_list.hpp"
#include "controller/cue_schedule.hpp"
#include "core/rig.hpp"

namespace footlight::app {

/// What one supply has to give in a show, in the words of the show.
struct SupplyFigures {
  struct Dimmed {
    std::string cue;    ///< number; empty: the opening
    double factor = 1;  ///< of every brightness
    double asked_a = 0;
  };
  std::string name;
  double limit_a = 0;
  int nodes = 0;
  int lamps = 0;
  double peak_a = 0;
  std::string peak_cue;  ///< number; empty: the opening
  double peak_s = 0;     ///< show time
  double mean_a = 0;
  double unguided_a = 0;  ///< without a controller
  std::vector<Dimmed> dimmed;
};

/// One for each supply that the rig lists.
[[nodiscard]] std::vector<SupplyFigures> supply_figures(const controller::CueSchedule& schedule, const Rig& rig,
                                                        std::span<const controller::CuePlay> plays);

/// "12 (3.4 s)", "the opening": when it gives most.
[[nodiscard]] std::string peak_text(const SupplyFigures& supply);
/// "cue 12 to 63 %, ...", empty when nothing is dimmed.
[[nodiscard]] std::string dimmed_text(const SupplyFigures& supply);
/// A line for each supply, each ended by a newline.
[[nodiscard]] std::string supplies_text(const std::vector<SupplyFigures>& supplies);
[[nodiscard]] nlohmann::ordered_json supplies_json(const std::vector<SupplyFigures>& supplies);

}  // namespace footlight::app
