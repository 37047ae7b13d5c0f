// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/time.hpp"

namespace footlight::controller {

/// Where a GO comes from.
enum class GoSource {
  keyboard,  ///< of a terminal: a key that is held repeats, and nobody tells when it is released
  lines,     ///< another program
  page,      ///< of the console in a browser
  network,   ///< OSC, MIDI Show Control
  button,    ///< on the desk, wired
  clock,     ///< timecode
};
/// Inputs that are told apart; whoever numbers more of them lets the last ones share a number.
inline constexpr std::size_t kMostGoInputs = 64;

/// One guard before GO for everything that can press it: a press that bounces, a key that is held and two people who
/// press at once are one GO.
///
/// A key counts again when it has been up, which a terminal shows by silence for `least`: every repeat puts that off.
/// An input that has been pressed for more than 5 s is switched off until somebody acknowledges it; the others stay,
/// also those of its kind.
/// Nothing is allocated. One thread.
class GoGuard {
 public:
  enum class Verdict { taken, too_soon, held, switched_off };

  /// @param least time between two GOs, from whatever source
  explicit GoGuard(Duration least) : least_(least) {}

  /// @param input which one, below kMostGoInputs  @param now not before the last call
  Verdict press(GoSource source, std::uint8_t input, Instant now) noexcept;
  /// Inputs that are switched off count again.
  void acknowledge() noexcept;
  /// Bit i: input i is switched off.
  [[nodiscard]] std::uint64_t off() const noexcept { return off_; }

 private:
  struct Input {
    Instant last = Instant::min();   ///< press, taken or not
    Instant first = Instant::min();  ///< of the presses that have gone on since
  };
  Duration least_;
  Instant taken_ = Instant::min();
  std::array<Input, kMostGoInputs> inputs_{};
  std::uint64_t off_ = 0;
};

}  // namespace footlight::controller
