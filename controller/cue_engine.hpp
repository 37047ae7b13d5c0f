// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "controller/bus_loop.hpp"
#include "controller/cue_list.hpp"
#include "controller/cue_schedule.hpp"

namespace footlight::controller {

enum class GoAnswer {
  started,
  running,       ///< refused: a cue runs, or follows by itself
  nothing_left,  ///< refused: the last cue has been played
};

enum class CueState { stopped, pre_wait, running, post_wait, done };
[[nodiscard]] std::string_view to_text(CueState state);

/// Where the show stands, as a function of the clock and of the GOs given: plays the cues in order, waits at the end of
/// a set where nothing follows by itself, and tells the buses which switch is lit and when the next one is due.
///
/// A GO starts the standby cue after its pre-wait, but no sooner than the buses can carry its first switch. A later
/// section's cue begins with the walk into it. While the show waits, its position stands still and the lamps keep.
/// Pure stepping; nothing is allocated, thrown or waited for after construction. Borrows the schedule. One thread.
class CueEngine {
 public:
  /// @param notices for each cue, how long before its first switch the buses have to know of it (BusLoop::notice)
  CueEngine(const CueSchedule& schedule, std::vector<CuePlay> plays, std::vector<Duration> notices);

  GoAnswer go(Instant now) noexcept;
  /// Lets everything up to and including `now` happen. `now` never goes back.
  void step(Instant now) noexcept;

  /// As of the last step or GO.
  [[nodiscard]] BusTarget target() const noexcept;
  /// Clock time of the next thing that happens without a GO; kNever while the show waits.
  [[nodiscard]] Instant next_event() const noexcept;
  /// Show time.
  [[nodiscard]] Instant position() const noexcept;
  [[nodiscard]] CueState state(std::size_t cue) const noexcept;
  /// The cue that the next GO starts; none after the last one.
  [[nodiscard]] std::optional<std::size_t> standby() const noexcept;
  /// The cue that runs or waits to run.
  [[nodiscard]] std::optional<std::size_t> active() const noexcept { return active_; }
  [[nodiscard]] bool finished() const noexcept { return !active_ && next_cue_ == plays_.size(); }
  [[nodiscard]] const std::vector<CuePlay>& plays() const noexcept { return plays_; }

 private:
  void begin(std::size_t cue, Instant at) noexcept;
  [[nodiscard]] Instant ends_at() const noexcept;
  /// Clock time at which switch `k` is due; kNever when that is not known yet.
  [[nodiscard]] Instant due(std::size_t k) const noexcept;

  const CueSchedule& schedule_;
  std::vector<CuePlay> plays_;
  std::vector<Duration> notices_;
  Instant now_;
  std::optional<std::size_t> active_;
  Instant begins_at_;         ///< clock time at which the active cue's stretch begins
  std::size_t next_cue_ = 0;  ///< after the active one, or the standby
  std::size_t lit_ = 0;       ///< switch that should be lit now
};

}  // namespace footlight::controller
