// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/plan.hpp"
#include "core/show.hpp"

namespace footlight::controller {

/// Shortest time that the show stands at the end of a set before the next GO; what a bus may use to preload the first
/// lamps of the next cue.
inline constexpr Duration kShortestHold = milliseconds(2000);

/// The stretch of show time that one cue plays: from the end of the cue before (so that the walk into a section belongs
/// to the section's own cue) to the end of its section.
struct CuePlay {
  Cue cue;
  Instant from;
  Instant to;
  /// How long the show stands at the end of the set before the next cue's first walk: nothing when it waits for GO.
  /// Zero for a cue that runs straight into the next one.
  std::optional<Duration> gap_after;

  /// True when people may stand at the end of this cue for a while.
  [[nodiscard]] bool stands_after() const { return !gap_after || gap_after->count() > 0; }
};

/// Cues in the order in which they are played. A show without cues gets one for each section, "1", "2", ..., each
/// following the one before by itself. Sections that no cue names are played by the next cue, those after the last cue
/// by the last one. The plan's first instant opens the first cue, its last instant closes the last one.
///
/// auto-follow: the next cue begins post_wait after the end of this one's section, plus its own pre_wait.
/// auto-continue: post_wait after this one's start, but never before the end of its section, plus the next's pre_wait.
[[nodiscard]] std::vector<CuePlay> cue_plays(const Show& show, const Plan& plan);

}  // namespace footlight::controller
