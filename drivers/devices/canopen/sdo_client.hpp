// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "drivers/transport.hpp"

namespace footlight::drivers::canopen {

/// An entry of a node's object dictionary.
struct ObjectPlace {
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
};

/// One SDO transfer at a time with one node (CiA 301, 7.2.4): expedited up to four bytes, in segments beyond. Pure: it
/// says what to send and is told what came.
class SdoClient {
 public:
  enum class State { idle, waiting, done, aborted };

  /// Both end what was under way before. @param node 1..127
  CanFrame read(std::uint8_t node, ObjectPlace place);
  CanFrame write(std::uint8_t node, ObjectPlace place, std::span<const std::uint8_t> bytes);
  /// @return what has to be sent because of the frame; frames that are no answer to the transfer change nothing
  std::optional<CanFrame> take(const CanFrame& frame);
  /// The node has not answered. @return the abort to send
  CanFrame give_up();

  [[nodiscard]] State state() const { return state_; }
  /// Of a read that is done.
  [[nodiscard]] const std::vector<std::uint8_t>& data() const { return data_; }
  /// Why it was aborted, by either side.
  [[nodiscard]] std::uint32_t abort_code() const { return abort_code_; }

 private:
  [[nodiscard]] CanFrame request(std::uint8_t command) const;
  void begin(std::uint8_t node, ObjectPlace place);
  CanFrame abort(std::uint32_t code);
  std::optional<CanFrame> take_first(const CanFrame& frame);
  std::optional<CanFrame> take_read_segment(const CanFrame& frame);
  std::optional<CanFrame> take_write_segment(const CanFrame& frame);
  CanFrame next_write_segment();

  State state_ = State::idle;
  std::uint8_t node_ = 0;
  ObjectPlace place_;
  bool writes_ = false;
  bool in_segments_ = false;
  std::uint8_t toggle_ = 0;  ///< of the segment under way: 0 or 0x10
  std::size_t sent_ = 0;
  std::vector<std::uint8_t> data_;
  std::uint32_t abort_code_ = 0;
};

}  // namespace footlight::drivers::canopen
