// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/live/live_run.hpp"
#include "app/rehearsing/rehearsal_entry.hpp"
#include "controller/cue_list.hpp"
#include "core/show.hpp"

namespace footlight::app {

/// What a rehearsal has come to, by cue.
struct RehearsalReport {
  struct OfCue {
    std::string number;
    std::string name;
    int starts = 0;
    int ends = 0;
    std::vector<double> holds;  ///< counts
    int goes_on = 0;
    int resets = 0;                            ///< to its beginning or into it
    double run_s = 0;                          ///< wall-clock time between its starts and its holds and ends
    std::optional<double> go_to_last_lamp_ms;  ///< of the last start, where the run told
    std::uint64_t late_nodes = 0;              ///< not confirmed right at its end
    std::vector<RehearsalEntry> notes;
  };
  std::string title;
  double began_since_1970_s = 0;
  double lasted_s = 0;
  int programs = 0;  ///< more than one: it was cut off and begun again
  std::vector<OfCue> cues;
  std::vector<RehearsalEntry> notes;  ///< that belong to no cue
  std::vector<std::string> alarms;
  int refused = 0;
  std::optional<std::uint64_t> late_latches;  ///< where the run told
  std::optional<double> worst_latch_ms;
  std::vector<std::string> absent;  ///< names
};

/// @param live of the run that has just ended; null: it was interrupted
[[nodiscard]] RehearsalReport report_of(const Show& show, const std::vector<controller::CuePlay>& plays,
                                        const std::vector<RehearsalEntry>& entries, const LiveReport* live);

[[nodiscard]] std::string rehearsal_text(const RehearsalReport& report);
[[nodiscard]] std::string rehearsal_json(const RehearsalReport& report);
/// One page that needs nothing else.
[[nodiscard]] std::string rehearsal_html(const RehearsalReport& report);

}  // namespace footlight::app
