// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/time.hpp"

namespace footlight::controller {

/// MIDI clock: F8 24 times a quarter note, FA start, FB continue, FC stop, F2 song position in sixteenths (MIDI 1.0,
/// "System Real Time Messages", "Song Position Pointer"). A clock that runs before anything was started says nothing.
/// Does not allocate. One thread.
class MidiClockDecoder {
 public:
  /// A place in quarter notes from the beginning of the song.
  struct Beat {
    Instant at;
    double quarters = 0;
  };
  /// @return the place, at most every 30 ms
  std::optional<Beat> take(std::span<const std::uint8_t> message, Instant at) noexcept;
  [[nodiscard]] bool runs() const noexcept { return runs_; }

 private:
  bool runs_ = false;
  std::int64_t clocks_ = 0;  ///< number of the next one
  std::optional<Instant> told_at_;
};

}  // namespace footlight::controller
