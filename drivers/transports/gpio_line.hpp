// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace footlight::drivers {

/// A line of a GPIO chip by libgpiod (version 1 or 2, whichever the program was built with): a GO button, a cue light,
/// a tally, the direction of an RS-485 transceiver. Thread: one. On and off are logical: what is active low is on when
/// its level is low.
class GpioLine {
 public:
  virtual ~GpioLine() = default;
  /// Outputs only.
  virtual Status<> set(bool on) = 0;
  /// Inputs only: how it is now.
  virtual Result<bool> read() = 0;
  /// Inputs only: takes the oldest edge that waits. The kernel keeps 16 and drops the newest without notice, so `read`
  /// has the last word.
  /// @return how the line was after it; nothing when none waits
  virtual Result<std::optional<bool>> take_edge() = 0;
  /// Inputs: file descriptor that becomes readable at an edge; outputs: -1.
  [[nodiscard]] virtual int poll_handle() const = 0;
};

struct GpioSettings {
  enum class Direction : std::uint8_t { output, input };
  enum class Bias : std::uint8_t { as_is, pull_up, pull_down };
  Direction direction = Direction::output;  ///< outputs begin off
  bool active_low = false;
  Bias bias = Bias::as_is;  ///< inputs
};

/// @param chip as "gpiochip0", "/dev/gpiochip0" or the chip's label
/// @param offset of the line on its chip
/// Errors: ErrorKind::device: no such chip, line in use, or a program built without libgpiod.
[[nodiscard]] Result<std::unique_ptr<GpioLine>> open_gpio(const std::string& chip, unsigned offset,
                                                          const GpioSettings& settings);

/// A GPIO chip of this machine.
struct GpioChip {
  std::string name;   ///< "gpiochip0"; may be another one after the next start of the machine
  std::string label;  ///< of the driver; stays
  unsigned lines = 0;
};

/// @param path "/dev/gpiochip0"
/// Errors: ErrorKind::device: not one, not ours to open, or a program built without libgpiod.
[[nodiscard]] Result<GpioChip> read_gpio_chip(const std::string& path);

/// The paths of what are GPIO chips by their names, in the order of these.
[[nodiscard]] std::vector<std::string> gpio_chip_paths(const std::string& folder = "/dev");

}  // namespace footlight::drivers
