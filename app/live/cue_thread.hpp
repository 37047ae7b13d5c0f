// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <thread>
#include <vector>

#include "app/live/shared_target.hpp"
#include "app/live/waiting.hpp"
#include "app/show_on_wires.hpp"
#include "controller/bus_loop.hpp"
#include "core/clock.hpp"

namespace footlight::app {

/// The cue thread: steps the engine at its instants and tells the buses. It owns no port and never waits for a bus.
class CueThread {
 public:
  /// Borrows everything.
  CueThread(ShowOnWires& show, SharedTarget& target, const Clock& clock)
      : show_(show), target_(target), clock_(clock), waiting_(clock), go_at_(show.plays.size(), kNever) {}
  ~CueThread() { stop(); }
  CueThread(const CueThread&) = delete;
  CueThread& operator=(const CueThread&) = delete;

  /// @param news called when the target has changed; must not block
  void start(std::function<void()> news);
  void stop();
  void press_go() noexcept;
  void press_go_whenever_it_waits() noexcept;
  [[nodiscard]] bool finished() const noexcept { return finished_.load(std::memory_order_relaxed); }
  // After `stop`.
  /// By cue; kNever: no GO.
  [[nodiscard]] const std::vector<Instant>& go_at() const { return go_at_; }
  [[nodiscard]] bool real_time() const { return real_time_; }

 private:
  void run() noexcept;
  void press(Instant now) noexcept;
  void publish(Instant now) noexcept;

  ShowOnWires& show_;
  SharedTarget& target_;
  const Clock& clock_;
  Waiting waiting_;
  std::function<void()> news_;
  std::atomic<bool> stopping_{false};
  std::atomic<bool> finished_{false};
  std::atomic<bool> by_itself_{false};
  std::atomic<int> presses_{0};
  GoWhenWaiting go_;
  bool told_ = false;
  bool real_time_ = false;
  controller::BusTarget last_;
  std::vector<Instant> go_at_;
  std::thread thread_;
};

}  // namespace footlight::app
