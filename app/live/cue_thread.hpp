// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <thread>
#include <vector>

#include "app/live/seqlock.hpp"
#include "app/live/shared_target.hpp"
#include "app/live/spsc_ring.hpp"
#include "app/live/waiting.hpp"
#include "app/show_on_wires.hpp"
#include "controller/rehearsal.hpp"
#include "controller/time/chase.hpp"
#include "core/clock.hpp"

namespace footlight::app {

/// Where the show stands, for people.
struct ShowState {
  controller::Rehearsal::Phase phase = controller::Rehearsal::Phase::stands;
  controller::Rehearsal::Reset reset{};
  bool loops = false;
  controller::Rehearsal::Loop loop{};
  bool holds_at_end = false;
  int percent = 100;                           ///< tempo
  int wanted_percent = 100;                    ///< that was asked for, as far as the cue allows
  int limit_percent = 200;                     ///< of this cue
  int active = -1;                             ///< cue that runs, is frozen or waits to run
  int standby = -1;                            ///< cue that the next GO starts
  Instant position{};                          ///< show time
  Instant goes_at = kNever;                    ///< clock time at which a count-in ends
  Instant ends_at = kNever;                    ///< clock time at which the active cue ends
  Instant at{};                                ///< when this was so
  controller::Bars barred = 0;                 ///< what stands against whatever would come next, or holds what runs
  std::uint64_t inputs_off = 0;                ///< bit i: input i of the GO guard is switched off
  controller::Rehearsal::Whereabouts where{};  ///< for a program that may have to take the show up
  controller::Chase::View time{};              ///< what comes of the source of time
  controller::BusTarget target{};
  std::uint32_t plan = 0;  ///< whose cues and switches these are (SharedTarget)
};

/// How a show goes on that another program led.
struct TakenUp {
  controller::Rehearsal::Whereabouts where{};
  controller::Chase::Word time{};
};

/// A command and what came of it.
struct Answer {
  controller::Command command{};
  controller::Outcome outcome{};
  Instant at{};
};

/// The cue thread: steps the rehearsal at its instants, takes commands and tells the buses. It neither locks,
/// allocates, logs nor touches a file; a flood of commands costs commands, and no cue.
class CueThread {
 public:
  /// Borrows everything; a rehearsal until another plan is taken.
  CueThread(controller::Rehearsal& rehearsal, TimeRules rules, SharedTarget& target, const Clock& clock);
  ~CueThread() { stop(); }
  CueThread(const CueThread&) = delete;
  CueThread& operator=(const CueThread&) = delete;

  /// Before the start.
  void take_up(const TakenUp& up, Instant now) noexcept;
  /// @param news called when the target has changed; must not block
  void start(std::function<void()> news);
  void stop();

  /// Another plan, put together beside the show.
  struct Next {
    std::uint32_t plan = 0;
    controller::Rehearsal* rehearsal = nullptr;  ///< it stands already where the show will stand in that plan
    std::vector<Instant> go_at{};                ///< kNever for each of its cues; then of the plan before
    Instant from{};                              ///< where the show has to stand in the plan before
  };
  enum class Handed : std::uint8_t { nothing, waiting, done, refused };

  // One thread.
  /// Goes over to another plan at once, or not at all where the show does not stand at `from` with everybody on a cell:
  /// `handed` tells. @param next borrowed until then
  void hand_over(Next& next) noexcept;
  /// What has come of it; done and refused are told once.
  [[nodiscard]] Handed handed() noexcept;
  /// @return false when there are too many: it is lost
  bool tell(const controller::Command& command) noexcept;
  std::optional<Answer> answer() noexcept { return answers_.pop(); }
  void press_go_whenever_it_waits() noexcept;
  /// What stands against walking; never lost.
  void set_bars(controller::Bars bars) noexcept;

  // Any thread.
  [[nodiscard]] ShowState state() const noexcept { return state_.read(); }
  // After `stop`.
  /// Clock time of the last GO that started each cue; kNever: none did.
  [[nodiscard]] const std::vector<Instant>& go_at() const { return go_at_; }
  [[nodiscard]] bool real_time() const { return real_time_; }

 private:
  void run() noexcept;
  void take_commands(Instant now) noexcept;
  void carry_out(const controller::Command& command, Instant now) noexcept;
  void go_over(Instant now) noexcept;
  void press_by_itself(Instant now) noexcept;
  void publish(Instant now) noexcept;

  controller::Rehearsal* rehearsal_;
  controller::Chase chase_;
  SharedTarget& target_;
  const Clock& clock_;
  Waiting waiting_;
  std::function<void()> news_;
  SpscRing<controller::Command, 64> commands_;
  SpscRing<Answer, 256> answers_;
  SeqLock<ShowState> state_;
  std::atomic<Next*> next_{nullptr};
  std::atomic<Handed> handed_{Handed::nothing};
  std::uint32_t plan_ = 0;
  std::atomic<bool> stopping_{false};
  std::atomic<bool> by_itself_{false};
  std::atomic<controller::Bars> bars_{0};
  controller::Bars barred_ = 0;  ///< as the rehearsal knows it
  GoWhenWaiting go_;
  bool told_ = false;
  bool real_time_ = false;
  controller::BusTarget last_;
  std::vector<Instant> go_at_;  ///< by cue
  std::thread thread_;
};

}  // namespace footlight::app
