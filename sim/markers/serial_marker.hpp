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
  /// Answers to WHO come in one of so many slots.
  static constexpr int kSlots = 8;
  static constexpr std::size_t kSlotCharacters = 30;

  /// @param address 1..254  @param model borrowed
  SerialMarker(std::uint8_t address, NodeModel& model, std::uint32_t unique_id = 0)
      : address_(address), unique_id_(unique_id), model_(model) {}

  [[nodiscard]] std::uint8_t address() const { return address_; }
  /// The slot of the last answer: 0, but for those to WHO. A slot is kSlotCharacters and 2 ms long.
  [[nodiscard]] int answer_slot() const { return answer_slot_; }

  /// Forgets half a frame and its counts; the model is powered on by its owner.
  void power_on();
  /// @return the frame with which the node answers the last request in `bytes`, delimiters included; empty: silent
  std::vector<std::uint8_t> receive(std::span<const std::uint8_t> bytes, Instant now);
  /// Frames of wrong check sum, version or length since power-on.
  [[nodiscard]] std::uint16_t dropped() const { return dropped_; }

 private:
  static constexpr std::size_t kLongestEncoded = 50;  ///< 9 bytes of header and check sum, 40 of body, 1 of COBS

  std::vector<std::uint8_t> end_of_frame(Instant now);
  [[nodiscard]] bool is_fenced(std::span<const std::uint8_t> payload, Instant now) const;
  /// @param payload header and body without the check sum
  std::vector<std::uint8_t> obey(std::span<const std::uint8_t> payload, Instant now);
  std::vector<std::uint8_t> preload(std::span<const std::uint8_t> payload);
  [[nodiscard]] std::vector<std::uint8_t> status(std::uint8_t plan_byte) const;
  std::vector<std::uint8_t> content(std::span<const std::uint8_t> payload);
  [[nodiscard]] std::vector<std::uint8_t> clock(std::uint8_t plan_byte, Instant now) const;
  std::vector<std::uint8_t> who(std::uint8_t plan_byte, std::uint8_t round);
  std::vector<std::uint8_t> take_address(std::span<const std::uint8_t> payload);
  [[nodiscard]] std::vector<std::uint8_t> health(std::uint8_t plan_byte, Instant now) const;
  std::vector<std::uint8_t> keep(std::span<const std::uint8_t> payload);
  [[nodiscard]] std::vector<std::uint8_t> i_am(std::uint8_t command, std::uint8_t plan_byte) const;
  std::vector<std::uint8_t> drop() {
    ++dropped_;
    return {};
  }

  std::uint8_t address_;
  std::uint32_t unique_id_;
  int answer_slot_ = 0;
  NodeModel& model_;
  std::array<std::uint8_t, kLongestEncoded> heard_{};
  std::size_t heard_size_ = 0;
  bool too_long_ = false;
  std::uint16_t dropped_ = 0;
};

}  // namespace footlight::sim
