// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <iosfwd>
#include <span>
#include <string>
#include <string_view>

#include "core/time.hpp"

namespace footlight::sim {

/// Everything that happens, one line each, in order: "microseconds bus direction hex note".
///   12.345 stage-left > 080#11            a frame of the controller, complete on the wire at 12.345 us
///   15.000 stage-left < 181#1101.. lost by controller
///   15.100 stage-left * - n7 latched 17   something inside a node
class Trace {
 public:
  /// @param out null: off, and then callers make no lines at all
  explicit Trace(std::ostream* out) : out_(out) {}

  [[nodiscard]] bool on() const { return out_ != nullptr; }
  void line(Instant at, std::string_view bus, char direction, std::string_view hex, std::string_view note);

 private:
  std::ostream* out_;
  std::string buffer_;
};

/// Upper-case, two digits a byte.
[[nodiscard]] std::string to_hex(std::span<const std::uint8_t> bytes);

}  // namespace footlight::sim
