// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "core/timecode.hpp"

namespace footlight::controller {

/// MIDI Time Code out of whole MIDI messages: quarter frames (F1 0nnndddd) and full frames
/// (F0 7F cc 01 01 hr mn sc fr F7); others are passed over. Source: MIDI Time Code (MMA RP-004/RP-008).
///
/// Eight quarter frames name the code of the instant of piece 0: forwards that was seven quarters of a frame before the
/// eighth comes, backwards piece 0 comes last. Does not allocate. One thread.
class MtcDecoder {
 public:
  /// @param message with its status byte  @param at when its last byte came
  /// @return where the source is at `at`, once for each whole code
  std::optional<TimeFix> take(std::span<const std::uint8_t> message, Instant at) noexcept;
  /// The last whole code.
  [[nodiscard]] const std::optional<Timecode>& last() const noexcept { return last_; }

 private:
  std::optional<TimeFix> quarter(std::uint8_t data, Instant at) noexcept;
  std::optional<TimeFix> full_frame(std::span<const std::uint8_t> message, Instant at) noexcept;

  std::array<std::uint8_t, 8> pieces_{};
  int expected_ = -1;  ///< number of the next piece, forwards; -1: none yet
  int in_a_row_ = 0;   ///< pieces since the last that did not fit
  int direction_ = 1;
  std::optional<Timecode> last_;
};

/// Quarter frame `piece` (0 to 7) of a code: F1 and its data.
[[nodiscard]] std::array<std::uint8_t, 2> mtc_quarter(const Timecode& code, int piece);
/// To all devices: a place at once, as after a jump.
[[nodiscard]] std::array<std::uint8_t, 10> mtc_full_frame(const Timecode& code);

}  // namespace footlight::controller
