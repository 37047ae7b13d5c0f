// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>

#include "controller/bars.hpp"
#include "controller/cue_engine.hpp"
#include "controller/go_guard.hpp"
#include "controller/stands.hpp"
#include "core/tempo_map.hpp"

namespace footlight::controller {

/// What somebody at the desk wants. Names are resolved before: a command knows positions of the show alone.
struct Command {
  enum class Kind : std::uint8_t {
    go,                ///< whatever comes next: the standby cue, going on, the reset move
    hold,              ///< freeze: the show stands at once, in the middle of a walk if need be
    hold_at_end,       ///< of the set: where everybody next stands
    run_on,            ///< takes `hold_at_end` back
    back,              ///< to the beginning of this cue; from there, of the one before
    jump,              ///< to `position`
    loop,              ///< from `position` to `until`, again and again
    loop_off,          ///<
    tempo,             ///< `percent` of the written one
    step,              ///< a count and no more
    reset_planned,     ///< the move that was asked for is ready
    reset_impossible,  ///< there is none
    placed,            ///< people stand where they must be, by the operator's word: no reset move is needed
    cancel,            ///< the jump
    acknowledge,       ///< inputs that were switched off
    time_fix,          ///< the source of time is at `position` at clock time `at` (`Chase`)
    follow,            ///< the source of time, again
    unfollow,          ///< the show goes by its own clock
    join,              ///< asks for the way to where people next stand after the source of time
    mute,              ///< lamps of the show as from switch `first` on (CueSchedule::add); 0: nobody is muted
  };
  Kind kind = Kind::go;
  GoSource source = GoSource::lines;
  std::uint8_t input = 0;  ///< which one presses GO, for the guard
  Instant position{};
  Instant until{};
  Instant at{};  ///< by the clock
  int percent = 100;
  // Of a reset move.
  std::uint32_t reset = 0;          ///< as `Rehearsal::Reset::id`
  std::size_t first = 0;            ///< its first switch in the schedule
  const ResetMove* move = nullptr;  ///< lives as long as the schedule
  std::uint32_t said = 0;           ///< for whoever said it, to know the answer; 0: nobody
};

enum class Outcome : std::uint8_t {
  done,
  cue_started,
  goes_on,
  walks_on,  ///< to the end of the walk that a hold has cut; then the reset move is asked for again
  reset_started,
  // refused
  too_soon,
  key_held,
  switched_off,
  cue_runs,
  nothing_left,
  being_planned,  ///< the reset move is not ready
  no_way,         ///< no reset move was found: people have to be sent by word of mouth
  reset_runs,
  nothing_runs,
  at_the_top,
  no_reset,     ///< none is asked for
  reset_first,  ///< people stand elsewhere: the way to here comes before any other
  empty_range,
  gate_open,     ///< that the cue needs, or nobody knows
  hold_pressed,  ///< a hold button
  emergency_hold,
  not_ready,
  lost,       ///< it never reached the rehearsal: there were too many
  no_source,  ///< nothing that makes sense comes from a source of time
};
/// For whoever pressed: "the cue runs".
[[nodiscard]] std::string_view to_text(Outcome outcome);
[[nodiscard]] constexpr bool refused(Outcome outcome) { return outcome >= Outcome::too_soon; }

/// The cue engine in rehearsal: holds, jumps, loops, tempo.
///
/// What is lit is a function of the position, and the position only goes on with the clock; but people are not lamps.
/// Whatever wants another position (BACK, a jump, the end of a loop) asks for a *reset move*, a walk from where people
/// are assumed to stand to where they must be. Somebody else plans it and says `reset_planned`; the operator's GO says
/// that people stand where they are assumed, and lights it; when it is over the show stands at its new place. Nothing
/// else moves the position, but `placed`, by which the operator answers for where people are.
///
/// GO, going on and the way back begin with a count-in of so many counts. Pure stepping; `step` and `apply` neither
/// allocate, lock nor throw. Borrows the engine. One thread.
class Rehearsal {
 public:
  enum class Phase : std::uint8_t { stands, counts_in, runs, resets, reset_held, finished };
  enum class ResetState : std::uint8_t { none, wanted, ready, impossible };
  struct Reset {
    ResetState state = ResetState::none;
    std::uint32_t id = 0;
    Instant from{};  ///< where people will stand when it begins
    Instant to{};
  };
  struct Loop {
    Instant from{};
    Instant to{};
  };
  struct Settings {
    double count_in_counts = 4;
    Duration least_between_gos = milliseconds(1000);
    Duration before_count_in{};  ///< for whoever tells the first count and has to know of it
  };
  /// Where a show was when another program led it last.
  struct Whereabouts {
    Instant position{};                   ///< show time
    std::optional<std::size_t> cue{};     ///< that runs or stands there; none: the show waits between two cues
    bool waits = true;                    ///< nobody has begun the walk of that very instant
    std::optional<Instant> runs_since{};  ///< by the clock it was there, or will be; none: it stands
    int percent = 100;                    ///< of the tempo, as it was asked for
    std::optional<Instant> hold_at{};     ///< it will stand there: at the end of the set
    std::optional<Instant> step_to{};     ///< or there: one count
    std::optional<Loop> loop{};
  };
  /// How long before a switch all buses have to know of it. @param from what is lit before
  using Notice = std::function<Duration(std::size_t from, std::size_t to)>;

  Rehearsal(CueEngine& engine, TempoMap tempo, Stands stands, Settings settings, Notice notice);

  /// The show stands here, held, also in the middle of a walk: a program that was started again, at the place where
  /// people were last. Before the first step. @param position clamped to the show
  void begin_at(Instant position) noexcept;
  /// Before the first step: goes on, or stands, as if this had led the show all the time. Of a reset move that was
  /// under way only its end is known. A position that is not on the show is held at its ends.
  void take_up(const Whereabouts& where, Instant now) noexcept;
  /// What another program has to know to take the show up, as of the last step.
  [[nodiscard]] Whereabouts whereabouts() const noexcept;
  /// The show stands here, and people stand elsewhere: before anything else a reset move, which only waits for GO.
  /// @param first its first switch, which shows people where they stand (build_reset, `stand`)
  void begin_elsewhere(Instant position, std::size_t first, const ResetMove& move) noexcept;
  /// Takes what does not belong to a plan from the rehearsal of the plan before: tempo, what the GO guard knows, bars.
  void carry_on(const Rehearsal& before, Instant now) noexcept;
  /// True where another plan may be taken: everybody stands on a cell, nothing runs and nobody is on another way.
  [[nodiscard]] bool may_change_plan() const noexcept;

  /// Lets everything up to and including `now` happen. `now` never goes back.
  void step(Instant now) noexcept;
  /// What stands against walking from now on. A cue that runs and is concerned is held at once; one that would follow
  /// by itself does not, and the show stands at the end of the set before it. When a bar goes nothing moves: GO does.
  void set_bars(Bars bars, Instant now) noexcept;
  /// O(log switches) and one `notice`.
  Outcome apply(const Command& command, Instant now) noexcept;

  /// A source of time begins or goes on with what stands, at clock time `at` or as soon as the buses can: no guard, no
  /// count-in but the time until then.
  Outcome start(Instant now, Instant at) noexcept;
  /// As `CueEngine::move_start`, `lead` and `make_up`.
  void move_start(Instant now, Instant at) noexcept;
  void lead(Instant now, std::optional<int> ppm) noexcept;
  void make_up(Instant now, Duration ahead) noexcept;

  /// As of the last step or command.
  [[nodiscard]] BusTarget target() const noexcept;
  /// Clock time of the next thing that happens by itself; kNever while the show waits.
  [[nodiscard]] Instant next_event() const noexcept;
  [[nodiscard]] Phase phase() const noexcept;
  [[nodiscard]] const Reset& reset() const noexcept { return reset_; }
  [[nodiscard]] const std::optional<Loop>& loop() const noexcept { return loop_; }
  [[nodiscard]] bool holds_at_end() const noexcept { return hold_.has_value(); }
  /// Clock time at which the count-in ends; kNever without one.
  [[nodiscard]] Instant goes_at() const noexcept;
  /// What stands against whatever would come next, or holds what runs.
  [[nodiscard]] Bars barred() const noexcept;
  /// Bit i: input i of the GO guard is switched off.
  [[nodiscard]] std::uint64_t inputs_off() const noexcept { return guard_.off(); }
  [[nodiscard]] const CueEngine& engine() const noexcept { return engine_; }
  [[nodiscard]] const Stands& stands() const noexcept { return stands_; }

 private:
  Outcome go(const Command& command, Instant now) noexcept;
  Outcome go_on(Instant now) noexcept;
  Outcome hold(Instant now) noexcept;
  Outcome hold_at_end(Instant now) noexcept;
  Outcome back(Instant now) noexcept;
  Outcome jump(Instant position, Instant now) noexcept;
  Outcome set_loop(const Command& command, Instant now) noexcept;
  Outcome step_count(Instant now) noexcept;
  Outcome placed() noexcept;
  Outcome cancel() noexcept;
  Outcome answer_reset(const Command& command) noexcept;
  Outcome mute(std::size_t first, Instant now) noexcept;
  [[nodiscard]] BusTarget target_of_all() const noexcept;
  [[nodiscard]] std::size_t muted(std::size_t k, std::size_t first) const noexcept;
  Outcome start_reset(Instant now) noexcept;
  void arrive() noexcept;
  void aim() noexcept;
  void obey_bars(Instant now) noexcept;
  [[nodiscard]] Bars bars_at(Instant position) const noexcept;
  [[nodiscard]] bool runs() const noexcept { return engine_.active() && !engine_.frozen(); }
  [[nodiscard]] bool resets() const noexcept { return move_ != nullptr; }
  [[nodiscard]] bool stands_for_reset() const noexcept;
  [[nodiscard]] Duration count_in() const noexcept;
  /// 1 where the first row of the move is lit already.
  [[nodiscard]] std::size_t first_row() const noexcept { return elsewhere_ ? 1 : 0; }
  /// Rows of the reset move that are lit: all but the last.
  [[nodiscard]] std::size_t rows() const noexcept;
  [[nodiscard]] Instant row_at(std::size_t row) const noexcept;
  [[nodiscard]] std::size_t row_switch(std::size_t row) const noexcept;

  CueEngine& engine_;
  TempoMap tempo_;
  Stands stands_;
  Settings settings_;
  Notice notice_;
  GoGuard guard_;
  Bars bars_ = 0;
  Instant now_{};
  std::optional<Instant> hold_;   ///< stop here: end of the set
  std::optional<Instant> count_;  ///< stop here: one count
  std::optional<Loop> loop_;
  Reset reset_;
  std::uint32_t resets_asked_ = 0;
  // The reset move that is ready or under way.
  const ResetMove* planned_ = nullptr;
  const ResetMove* move_ = nullptr;
  std::size_t first_ = 0;              ///< its first switch
  bool elsewhere_ = false;             ///< people do not stand where the show does
  Instant move_at_{};                  ///< clock time at which it begins or began
  std::size_t rows_lit_ = 0;           ///< of it
  std::optional<Duration> move_held_;  ///< it stands so far from its beginning
  // First switch of the lamps that are lit, and of those that will be at `mutes_at_`; 0: nobody is muted.
  std::size_t muting_ = 0;
  std::size_t muting_next_ = 0;
  Instant mutes_at_ = kNever;
};

}  // namespace footlight::controller
