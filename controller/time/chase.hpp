// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "controller/rehearsal.hpp"
#include "controller/time/time_follower.hpp"

namespace footlight::controller {

/// Something about the source of time that the operator has to know.
enum class TimeAlarm : std::uint8_t {
  none,
  follows,     ///< again, or for the first time
  freewheels,  ///< nothing comes; the show goes on at the last speed
  lost,        ///< nothing came for longer: the show's rule is carried out
  jumped,      ///< more than 500 ms off: the show holds
  too_fast,    ///< faster than the walks of the cue were proved for
};

/// The show follows a source of time, by the rules that are written in the show (docs/time.md).
///
/// What stands where everybody stands begins in the moment at which the source passes its place, forwards; nothing is
/// played again, and nothing is caught up with in a burst. While a cue runs and the source is up to 80 ms off, the show
/// goes up to 10 % faster or slower than the source until they agree. Up to 500 ms off: where everybody next stands it
/// makes one step, ahead as far as the walks that begin there are proved for, back by waiting. Further off: it goes on
/// to where everybody next stands, holds there, and asks for a reset move to where the source is found; it moves nobody
/// by itself. Never faster than the cue's tempo limit, whatever the source does.
///
/// The operator goes first: after a hold the source begins nothing until somebody says GO or `follow`.
///
/// What bars hold, the source does not begin either. Pure stepping, after the rehearsal's; allocates nothing. Borrows
/// the rehearsal. One thread.
class Chase {
 public:
  static constexpr Duration kSlewed = milliseconds(80);
  static constexpr Duration kStepped = milliseconds(500);
  static constexpr Duration kPeriod = milliseconds(20);   ///< `step` wants to be called so often
  static constexpr Duration kAhead = milliseconds(3000);  ///< a start is told to the buses at most so long before

  /// What people see of it.
  struct View {
    bool there = false;    ///< something was heard at all
    bool on = true;        ///< it may lead the show
    bool armed = true;     ///< it may begin what stands
    bool follows = false;  ///< the show goes with it now
    TimeFollower::State state = TimeFollower::State::none;
    Instant source{};  ///< where it is, in the show's time; of no meaning before it has locked
    Duration off{};    ///< the source's position less the show's
    double rate = 1;
    TimeAlarm alarm = TimeAlarm::none;  ///< the last one
    std::uint32_t alarms = 0;           ///< so many
    Duration alarm_off{};               ///< when it was given
  };

  /// What outlives the program: whether the source may lead the show, and begin what stands.
  struct Word {
    bool on = true;
    bool armed = true;
    friend bool operator==(const Word&, const Word&) = default;
  };

  Chase(Rehearsal& rehearsal, TimeRules rules);
  /// Before the first step: as it was under another program.
  void take_up(const Word& word) noexcept;
  /// From now on that of another plan; the show stands.
  void carry_on(Rehearsal& rehearsal, Instant now) noexcept;

  /// What the source has said: `time_fix`.
  void hear(const Command& fix) noexcept;
  /// Any other order: those for the rehearsal go on to it. @return what came of it
  Outcome take(const Command& command, Instant now) noexcept;
  void step(Instant now) noexcept;
  /// Clock time at which `step` is wanted next; kNever before anything was heard.
  [[nodiscard]] Instant next_event(Instant now) const noexcept { return view_.there ? now + kPeriod : kNever; }
  /// As of the last step.
  [[nodiscard]] const View& view() const noexcept { return view_; }

 private:
  Outcome join(Instant now) noexcept;
  void begin(Instant source, Instant now) noexcept;
  void follow(Instant source, Instant now) noexcept;
  void hold_for_jump(Instant source, Instant now) noexcept;
  void lose(Instant now) noexcept;
  void let_go(Instant now) noexcept;
  void lead(Instant now, double speed) noexcept;
  void step_ahead(Instant here, Duration off, Instant now) noexcept;
  void tell(TimeAlarm alarm) noexcept;
  void say(Command::Kind kind, Instant position, Instant now) noexcept;
  [[nodiscard]] bool runs() const noexcept;
  [[nodiscard]] const CueEngine& engine() const noexcept { return rehearsal_->engine(); }
  [[nodiscard]] const Stands& stands() const noexcept { return rehearsal_->stands(); }

  Rehearsal* rehearsal_;
  TimeRules rules_;
  TimeFollower follower_;
  View view_;
  bool leads_ = false;                ///< the engine goes at the source's speed, or at its last one
  int led_ppm_ = 0;                   ///< by that speed
  bool silent_ = false;               ///< told
  bool fast_ = false;                 ///< told
  bool waits_ = false;                ///< ahead of the source: it waits where everybody next stands
  std::optional<Instant> step_from_;  ///< position from which the show steps ahead
};

[[nodiscard]] std::string_view to_text(TimeAlarm alarm);

}  // namespace footlight::controller
