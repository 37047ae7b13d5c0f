// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

#include "core/time.hpp"

namespace footlight {

/// The only source of "now"; passed in wherever time matters, so that a whole show runs in virtual time.
class Clock {
 public:
  virtual ~Clock() = default;
  /// Monotonic; zero is chosen by the clock. Thread: any. Hot path: yes.
  [[nodiscard]] virtual Instant now() const = 0;
};

/// The machine's monotonic clock, zero at construction. Steps of the wall clock do not move it.
class SteadyClock final : public Clock {
 public:
  SteadyClock();
  [[nodiscard]] Instant now() const override;

 private:
  std::chrono::steady_clock::time_point zero_;
};

/// The machine's wall clock, since 1970-01-01 UTC: for what people and files call a time. It steps; nothing is timed by
/// it.
[[nodiscard]] Duration wall_time();

/// Stands still until it is told to move: dry runs and tests.
class ManualClock final : public Clock {
 public:
  [[nodiscard]] Instant now() const override { return Instant(Duration(now_.load(std::memory_order_acquire))); }
  /// Moves forward to `instant`; going back is a programmer error.
  void advance_to(Instant instant);
  void advance(Duration duration) { advance_to(now() + duration); }

 private:
  std::atomic<Duration::rep> now_{0};
};

}  // namespace footlight
