// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "app/live/live_run.hpp"
#include "core/show.hpp"
#include "core/time.hpp"

namespace footlight::app {

/// One beat of a count-in.
struct Beat {
  Instant at;      ///< clock
  int number = 0;  ///< to be said, 1..8; 0: only a click
  bool accented = false;

  friend bool operator==(const Beat&, const Beat&) = default;
};

/// The count-in that is heard: whole counts back from the instant at which people begin to walk, and that instant.
/// The numbers end with the last count before it: 1 2 3 4 for four counts; of more than eight only the last eight are
/// said, and before them is a click. Empty while none is under way.
/// @param counts of the count-in, as Rehearsal::Settings has it
[[nodiscard]] std::vector<Beat> count_in_beats(const Show& show, const DeskView& view, double counts);

/// A click for each count of the show, accented where a measure begins. @param from, to show time
[[nodiscard]] std::vector<Beat> click_track(const TempoMap& tempo, Instant from, Instant to);

}  // namespace footlight::app
