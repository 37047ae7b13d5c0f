// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/markers/node_model.hpp"

namespace footlight::sim {

/// A marker node that speaks Footlight serial (docs/wire-protocol.md, section 2). Takes any bytes in any pieces.
class SerialMarker {
 public:
  /// @param address 1..254  @param model borrowed
  SerialMarker(std::uint8_t address, NodeModel& model) : address_(address), model_(model) {}

  /// Forgets half a frame and its counts; the model is powered on by its owner.
  void power_on();
  /// @return the frame with which the node answers the last request in `bytes`, delimiters included; empty: silent
  std::vector<std::uint8_t> receive(std::span<const std::uint8_t> bytes, Instant now);
  /// Frames of wrong check sum, version or length since power-on.
  [[nodiscard]] std::uint16_t dropped() const { return dropped_; }

 private:
  static constexpr std::size_t kLongestEncoded = 50;  ///< 9 bytes of header and check sum, 40 of body, 1 of COBS

  std::vector<std::uint8_t> end_of_frame(Instant now);
  /// @param payload header and body without the check sum
  std::vector<std::uint8_t> obey(std::span<const std::uint8_t> payload, Instant now);
  std::vector<std::uint8_t> preload(std::span<const std::uint8_t> payload);
  [[nodiscard]] std::vector<std::uint8_t> status(std::uint8_t plan_byte) const;
  std::vector<std::uint8_t> drop() {
    ++dropped_;
    return {};
  }

  std::uint8_t address_;
  NodeModel& model_;
  std::array<std::uint8_t, kLongestEncoded> heard_{};
  std::size_t heard_size_ = 0;
  bool too_long_ = false;
  std::uint16_t dropped_ = 0;
};

}  // namespace footlight::sim
