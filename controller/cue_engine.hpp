// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
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

enum class CueState { stopped, pre_wait, running, paused, post_wait, done };
[[nodiscard]] std::string_view to_text(CueState state);

/// Speed of show time against the clock, in percent of the written tempo.
inline constexpr int kSlowest_percent = 25;
inline constexpr int kFastest_percent = 200;

/// The last switch that has happened at a position. Where the show waits, nobody has begun the walk of that very
/// instant: of its switches only the settled one counts, but at the end of the show. O(log switches)
[[nodiscard]] std::size_t lit_at(const CueSchedule& schedule, Instant position, bool waits);

/// Where the show stands, as a function of the clock and of the GOs given: plays the cues in order, waits at the end of
/// a set where nothing follows by itself, and tells the buses which switch is lit and when the next one is due.
///
/// A GO starts the standby cue after its pre-wait, but no sooner than the buses can carry its first switch. A later
/// section's cue begins with the walk into it. While the show waits, its position stands still and the lamps keep.
/// Waits are times of the clock; only the position knows a tempo.
/// Pure stepping; nothing is allocated, thrown or waited for after construction. Borrows the schedule. One thread.
class CueEngine {
 public:
  /// @param notices for each cue, how long before its first switch the buses have to know of it (BusLoop::notice)
  CueEngine(const CueSchedule& schedule, std::vector<CuePlay> plays, std::vector<Duration> notices);

  /// @param lead the cue starts no sooner: a count-in
  GoAnswer go(Instant now, Duration lead = {}) noexcept;
  /// The standby cue begins at `at`, or as soon as the buses can: its pre-wait is the source of time's affair.
  GoAnswer start(Instant now, Instant at) noexcept;
  /// What waits to run, or to go on, does so at `at` instead. @param at far enough from now for the buses
  void move_start(Instant now, Instant at) noexcept;
  /// Lets everything up to and including `now` happen. `now` never goes back.
  void step(Instant now) noexcept;

  /// The position stands still at once. A cue that waits to run, or to follow, is standby again.
  /// @return false when nothing runs
  bool freeze(Instant now) noexcept;
  /// A frozen cue goes on at `at`, not before now. @return false when none is frozen
  bool resume(Instant now, Instant at) noexcept;
  /// The position will not pass this: there the cue freezes before anybody begins the walk of that instant, or ends
  /// where it is its end, and nothing follows. Nothing: it runs on. Forgotten when the show stands.
  /// @param position later than the present one
  void stop_at(std::optional<Instant> position) noexcept { stop_ = position; }
  /// The show stands at a position at which nobody walks. Nothing may run: `freeze` before.
  void place(Instant position) noexcept;
  /// Before the first step, of a show that another program has led: this cue stands or runs at `position`, wherever
  /// people are on their ways. @param before nobody has begun the walk of that instant  @param runs_since by the clock
  /// it was there, or will be; none: it stands there
  void take_up(std::size_t cue, Instant position, bool before, std::optional<Instant> runs_since) noexcept;
  /// From now on. @param percent wanted; held at the active cue's limit  @param now not before the last step
  void set_tempo(Instant now, int percent) noexcept;
  /// A source of time leads: the position goes at its speed, never above the cue's limit, and each cue follows the one
  /// before without a wait. @param ppm parts of a million of the written tempo; nothing: nobody leads
  void lead(Instant now, std::optional<int> ppm) noexcept;
  /// The running cue goes so far ahead in one step, at most to its end. @param ahead not negative
  void make_up(Instant now, Duration ahead) noexcept;
  /// @param percent fastest for each cue, for a tempo above that is asked for; at least 25 each
  void set_limits(std::vector<int> percent);

  /// As of the last step or GO.
  [[nodiscard]] BusTarget target() const noexcept;
  /// Clock time of the next thing that happens without a GO; kNever while the show waits.
  [[nodiscard]] Instant next_event() const noexcept;
  /// Show time.
  [[nodiscard]] Instant position() const noexcept;
  /// Clock time at which the running cue gets to a position; kNever when it does not by itself.
  [[nodiscard]] Instant clock_at(Instant position) const noexcept;
  [[nodiscard]] CueState state(std::size_t cue) const noexcept;
  /// The cue that the next GO starts; none after the last one.
  [[nodiscard]] std::optional<std::size_t> standby() const noexcept;
  /// The cue that runs, is frozen or waits to run.
  [[nodiscard]] std::optional<std::size_t> active() const noexcept { return active_; }
  [[nodiscard]] bool frozen() const noexcept { return active_ && frozen_; }
  /// True when nobody has begun the walk of this very instant.
  [[nodiscard]] bool waits() const noexcept;
  /// Clock time at which the active cue begins or goes on; the past while it runs, kNever when none does.
  [[nodiscard]] Instant goes_at() const noexcept { return active_ && !frozen_ ? anchor_at_ : kNever; }
  [[nodiscard]] int wanted_percent() const noexcept { return wanted_percent_; }
  [[nodiscard]] bool finished() const noexcept { return !active_ && next_cue_ == plays_.size(); }
  /// Of the active cue, or of the standby.
  [[nodiscard]] int percent() const noexcept;
  /// The tempo that was asked for, limited or not.
  /// Fastest of the active cue, or of the standby.
  [[nodiscard]] int limit_percent() const noexcept;
  /// How long the show stands after a cue; nothing: until GO. A source of time that leads waits nowhere.
  [[nodiscard]] std::optional<Duration> gap_after(std::size_t cue) const noexcept;
  [[nodiscard]] const std::vector<CuePlay>& plays() const noexcept { return plays_; }
  [[nodiscard]] const CueSchedule& schedule() const noexcept { return schedule_; }

 private:
  void begin(std::size_t cue, Instant at) noexcept;
  void freeze_at(Instant position, bool before) noexcept;
  [[nodiscard]] Instant ends_at() const noexcept;
  /// Clock time at which switch `k` is due; kNever when that is not known yet.
  [[nodiscard]] Instant due(std::size_t k) const noexcept;
  void anchor_here(Instant here) noexcept;
  [[nodiscard]] int percent_of(std::size_t cue) const noexcept;
  /// Speed of the position while a cue runs.
  [[nodiscard]] Duration::rep speed_ppm(std::size_t cue) const noexcept;
  /// The active one, or the standby.
  [[nodiscard]] std::size_t cue_of_tempo() const noexcept;

  const CueSchedule& schedule_;
  std::vector<CuePlay> plays_;
  std::vector<Duration> notices_;
  std::vector<int> limits_;  ///< of each cue, percent
  int wanted_percent_ = 100;
  std::optional<int> led_ppm_;
  Instant now_;
  std::optional<std::size_t> active_;
  // Where the active cue is: at `anchor_at_` by the clock it is, or will be, at `anchor_` of the show.
  Instant anchor_at_;
  Instant anchor_;
  bool frozen_ = false;          ///< it stands at `anchor_`
  bool before_ = true;           ///< it is there and nobody has begun the walk of that instant
  std::optional<Instant> stop_;  ///< show time
  std::size_t next_cue_ = 0;     ///< after the active one, or the standby
  std::size_t lit_ = 0;          ///< switch that should be lit now
};

}  // namespace footlight::controller
