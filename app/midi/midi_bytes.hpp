// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace footlight::app {

/// Longer messages are not for a show: they are left out and counted.
inline constexpr std::size_t kLongestMidiMessage = 256;

/// A stream of MIDI bytes, cut anywhere, as whole messages (MIDI 1.0 Detailed Specification): running status is written
/// out, real-time bytes come through in the middle of others, system exclusive is whole from F0 to F7 or not at all.
/// Whatever comes, nothing is allocated. One thread.
class MidiBytes {
 public:
  /// @return the message that `byte` has made whole, with its status byte; empty: none. Valid until the next call.
  std::span<const std::uint8_t> take(std::uint8_t byte) noexcept;
  /// Messages that were too long or cut off by another one.
  [[nodiscard]] std::uint64_t lost() const noexcept { return lost_; }

 private:
  std::span<const std::uint8_t> begin(std::uint8_t status) noexcept;

  std::array<std::uint8_t, kLongestMidiMessage> bytes_{};
  std::size_t size_ = 0;    ///< 0: no status that data would belong to
  std::size_t wanted_ = 0;  ///< size of the whole message; 0: until F7
  bool too_long_ = false;
  std::uint8_t real_time_ = 0;
  std::uint64_t lost_ = 0;
};

}  // namespace footlight::app
