// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "app/live/node_board.hpp"
#include "app/live/seqlock.hpp"
#include "app/live/shared_target.hpp"
#include "app/live/waiting.hpp"
#include "controller/bus_loop.hpp"
#include "controller/lateness.hpp"
#include "core/clock.hpp"
#include "drivers/registry.hpp"

namespace footlight::app {

/// When a bus has lit a switch, and when all its nodes had said so; kNever: not.
struct SwitchTimes {
  Instant latched = kNever;  ///< handed to the port; on the wire its own time later. Never where no lamp changes
  Instant confirmed = kNever;
  std::uint32_t unconfirmed = 0;  ///< nodes, when the next switch was lit
};

/// The thread that owns one bus: its driver, its port, its loop. It sleeps until the wire has something, the loop wants
/// to be called or the cue thread has news.
///
/// The controller's heartbeats are the cue thread's: when that has not said anything for kDeaf, the bus stands still,
/// so that the markers' lease runs out and they hold, then lose guidance, as they would without a controller.
class BusThread {
 public:
  static constexpr Duration kDeaf = milliseconds(500);

  /// Borrows everything. @param port of the bus  @param switches of the schedule
  BusThread(controller::BusLoop& loop, drivers::PortReference port, const SharedTarget& target, const Clock& clock,
            std::size_t switches);
  ~BusThread();
  BusThread(const BusThread&) = delete;
  BusThread& operator=(const BusThread&) = delete;

  /// Before `start`. @param board told what becomes of each node; borrowed
  void tell(NodeBoard& board) { board_ = &board; }
  /// What the thread needs of another plan, to go over to it when the cue thread says so.
  struct Next {
    std::uint32_t plan = 0;
    std::unique_ptr<controller::BusLoop::Part> part;
    /// One for each switch; of the plan before, when the thread has gone over.
    std::vector<SwitchTimes> times{};
  };

  void start();
  void stop();
  /// Before the cue thread is told. @param next borrowed until `plan` is its number
  void prepare(Next& next) noexcept { next_.store(&next, std::memory_order_release); }
  void wake() const noexcept { waiting_.wake(); }

  // Any thread.
  /// Number of the newest plan that it has been told of: its nodes on the board know nothing of earlier ones.
  [[nodiscard]] std::uint32_t told() const noexcept { return told_.load(std::memory_order_acquire); }
  /// Number of the plan whose lamps it brings about.
  [[nodiscard]] std::uint32_t plan() const noexcept { return plan_.load(std::memory_order_acquire); }
  [[nodiscard]] bool settled() const noexcept { return settled_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::size_t unconfirmed() const noexcept { return unconfirmed_.load(std::memory_order_relaxed); }

  /// Not older than a tenth of a second, as long as the thread has something to do.
  struct Word {
    static constexpr std::size_t kLongestTrouble = 200;
    controller::BusCounters counters{};
    Duration confirmed_after{};  ///< of the last switch that all nodes have confirmed: so long after its latch
    std::array<char, kLongestTrouble> trouble{};  ///< why the wire is down, in whole words, ended by a zero; else empty
  };
  [[nodiscard]] Word word() const noexcept { return word_.read(); }
  [[nodiscard]] std::size_t quarantined() const noexcept { return quarantined_.load(std::memory_order_relaxed); }

  // After `stop`.
  [[nodiscard]] const controller::Lateness& wake_lateness() const { return wake_lateness_; }
  [[nodiscard]] const std::vector<SwitchTimes>& times() const { return times_; }
  [[nodiscard]] Duration cpu() const { return cpu_; }
  [[nodiscard]] std::uint64_t deaf() const { return deaf_; }
  [[nodiscard]] bool real_time() const { return real_time_; }
  [[nodiscard]] const controller::BusLoop& loop() const { return loop_; }

 private:
  void run() noexcept;
  /// @return when it wants to be called again
  Instant step(Instant now) noexcept;
  void note(Instant now) noexcept;
  void tell_board() noexcept;
  void tell_word(Instant now) noexcept;
  Instant go_over(Instant now, const SharedTarget::Told& told) noexcept;

  controller::BusLoop& loop_;
  drivers::PortReference port_;
  const SharedTarget& target_;
  const Clock& clock_;
  Waiting waiting_;
  std::atomic<bool> stopping_{false};
  std::atomic<Next*> next_{nullptr};
  std::atomic<std::uint32_t> plan_{0};
  std::atomic<std::uint32_t> told_{0};
  const controller::CueSchedule* before_ = nullptr;  ///< while the loop goes over: the one that it had
  std::atomic<bool> settled_{false};
  std::atomic<std::size_t> unconfirmed_{0};
  std::atomic<std::size_t> quarantined_{0};
  SeqLock<Word> word_;
  Word told_word_{};
  Instant word_at_ = Instant::min();
  NodeBoard* board_ = nullptr;
  controller::Lateness wake_lateness_;
  std::vector<SwitchTimes> times_;
  std::size_t lit_ = 0;
  std::uint64_t latches_ = 0;
  Duration cpu_{};
  std::uint64_t deaf_ = 0;  ///< times that the cue thread was not heard of
  bool is_deaf_ = false;
  bool real_time_ = false;
  std::thread thread_;
};

}  // namespace footlight::app
