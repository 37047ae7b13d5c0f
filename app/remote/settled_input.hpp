// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "core/time.hpp"
#include "drivers/transports/gpio_line.hpp"

namespace footlight::app {

/// The level of a hold button or of a gate's contact: what is worse counts at once, also when it was over before
/// anybody looked; what is better counts after a rest, for contacts bounce.
class SettledInput {
 public:
  /// @param worse the level that counts at once  @param now how it counts as long as nothing is known
  SettledInput(std::unique_ptr<drivers::GpioLine> line, bool worse, bool now)
      : line_(std::move(line)), worse_(worse), level_(now) {}
  /// Call when poll_handle() is readable and every 50 ms. @return how it counts. Errors: the line is gone.
  Result<bool> step(Instant now);
  [[nodiscard]] int poll_handle() const { return line_->poll_handle(); }

  static constexpr Duration kRest = milliseconds(100);

 private:
  std::unique_ptr<drivers::GpioLine> line_;
  bool worse_;
  bool level_;
  std::optional<Instant> better_since_;
};

}  // namespace footlight::app
