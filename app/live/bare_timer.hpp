// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <thread>

#include "app/live/waiting.hpp"
#include "controller/lateness.hpp"
#include "core/clock.hpp"

namespace footlight::app {

/// A thread that sleeps until an instant and does nothing else: what this machine can do, to measure the others by.
class BareTimer {
 public:
  /// @param clock borrowed
  explicit BareTimer(const Clock& clock);
  ~BareTimer() { stop(); }
  BareTimer(const BareTimer&) = delete;
  BareTimer& operator=(const BareTimer&) = delete;
  void stop();
  /// After `stop`.
  [[nodiscard]] const controller::Lateness& lateness() const { return lateness_; }

 private:
  void run() noexcept;

  const Clock& clock_;
  Waiting waiting_;
  std::atomic<bool> stopping_{false};
  controller::Lateness lateness_;
  std::thread thread_;
};

}  // namespace footlight::app
