// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/result.hpp"
#include "core/time.hpp"

namespace footlight::drivers {

/// One press for one push of a button, whatever its contact does: the first edge counts at once, then the input is
/// locked until it has been at rest for the whole lock-out. (The kernel's debounce would delay the press instead.)
class PressLockout {
 public:
  explicit PressLockout(Duration lockout) : lockout_(lockout) {}
  /// @param pressed the level now; call at each edge and at least once per lock-out
  /// @return true once for each push
  bool take(bool pressed, Instant now);

 private:
  Duration lockout_;
  bool locked_ = false;
  std::optional<Instant> at_rest_since_;
};

/// A line of a GPIO chip by libgpiod: a cue light, a GO button. Thread: one.
class GpioLine {
 public:
  virtual ~GpioLine() = default;
  /// Outputs only.
  virtual Status<> set(bool on) = 0;
  /// Inputs only: the level now.
  virtual Result<bool> read() = 0;
};

enum class GpioDirection { input, output };

/// @param chip as "gpiochip0", "/dev/gpiochip0" or the chip's label
/// @param offset of the line on its chip
/// Errors: ErrorKind::device: no such chip, line in use, or a program built without libgpiod.
[[nodiscard]] Result<std::unique_ptr<GpioLine>> open_gpio(const std::string& chip, unsigned offset,
                                                          GpioDirection direction);

}  // namespace footlight::drivers
