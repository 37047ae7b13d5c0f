// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace footlight::sim {

/// A DMX USB Pro widget as its maker describes it (ENTTEC, DMX USB Pro Widget API Specification 1.44): messages of
/// 0x7E, label, length (2, least significant first), data, 0xE7. Takes any bytes in any pieces; what it does not know
/// it ignores.
class UsbProWidget {
 public:
  static constexpr std::size_t kSlots = 512;

  /// @return what the widget answers, messages one after the other; empty: nothing
  std::vector<std::uint8_t> receive(std::span<const std::uint8_t> bytes);
  /// What goes out on the DMX line again and again: slot 1 first.
  [[nodiscard]] const std::array<std::uint8_t, kSlots>& slots() const { return slots_; }
  /// Slots of the last packet.
  [[nodiscard]] std::size_t sent() const { return sent_; }
  /// Packets taken over since construction.
  [[nodiscard]] std::uint64_t packets() const { return packets_; }

 private:
  static constexpr std::size_t kLongestData = 600;

  void obey(std::vector<std::uint8_t>& answer);

  std::vector<std::uint8_t> message_;  ///< from the start delimiter on
  std::array<std::uint8_t, kSlots> slots_{};
  std::size_t sent_ = 0;
  std::uint64_t packets_ = 0;
};

}  // namespace footlight::sim
