// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "core/time.hpp"
#include "drivers/transports/gpio_line.hpp"

namespace footlight::drivers {

/// One press for one push of a button, whatever its contact does: the first edge counts at once, then the input is
/// locked until it has been at rest for the whole lock-out. (The kernel's debounce would delay the press instead.)
/// An input that finds no rest for so long that nobody can mean it is stuck: it is off until it has been at rest for as
/// long.
class PushButton {
 public:
  enum class Event {
    none,
    pressed,
    stuck,  ///< once; alarm
    freed,  ///< once after `stuck`: it counts again
  };
  explicit PushButton(Duration lockout = kLockout, Duration stuck_after = kStuckAfter)
      : lockout_(lockout), stuck_after_(stuck_after) {}
  /// @param down how it is now; call at each edge and every kPollPeriod
  Event take(bool down, Instant now);
  [[nodiscard]] bool stuck() const { return stuck_; }

  static constexpr Duration kLockout = milliseconds(30);  ///< contacts bounce for up to 20 ms
  static constexpr Duration kStuckAfter = milliseconds(5000);
  static constexpr Duration kPollPeriod = milliseconds(50);

 private:
  Duration lockout_;
  Duration stuck_after_;
  std::optional<Instant> restless_since_;  ///< no rest of the whole lock-out since then
  std::optional<Instant> at_rest_since_;
  bool stuck_ = false;
};

/// A push button on an input line: edges as they come, and the level after them and every 50 ms, for the kernel may
/// have dropped the last edge.
class ButtonInput {
 public:
  /// @param line an input
  explicit ButtonInput(std::unique_ptr<GpioLine> line, PushButton button = PushButton())
      : line_(std::move(line)), button_(button) {}
  /// Call when poll_handle() is readable and every PushButton::kPollPeriod; until it answers `none`, more may have
  /// happened. Errors: the line is gone.
  Result<PushButton::Event> step(Instant now);
  [[nodiscard]] int poll_handle() const { return line_->poll_handle(); }
  [[nodiscard]] bool stuck() const { return button_.stuck(); }

 private:
  std::unique_ptr<GpioLine> line_;
  PushButton button_;
};

}  // namespace footlight::drivers
