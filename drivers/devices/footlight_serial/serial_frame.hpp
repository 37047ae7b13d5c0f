// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/look.hpp"
#include "drivers/driver.hpp"

namespace footlight::drivers::footlight_serial {

// Frames of docs/wire-protocol.md, section 2. Pure functions but for FrameReceiver.

enum class Command : std::uint8_t {
  preload = 1,
  latch = 2,
  heartbeat = 3,
  status = 4,
  look = 5,
  identify = 6,
  time = 7,
  clock = 8,
  content = 9,
  who = 10,
  address = 11,
  health = 12,
  lead = 13,  ///< from a node: it is fenced
  keep = 14
};
enum class Direction : std::uint8_t { from_controller = 0x01, from_node = 0x81 };

/// A frame's content: what CRC-32 covers.
struct Frame {
  Direction direction = Direction::from_controller;
  Command command = Command::status;
  std::uint8_t address = 0;
  std::uint8_t plan_byte = 0;
  Sequence sequence = 0;
  std::vector<std::uint8_t> body;

  friend bool operator==(const Frame&, const Frame&) = default;
};

inline constexpr std::size_t kLongestBody = 40;
inline constexpr std::size_t kReceiptBody = 2;
inline constexpr std::size_t kStatusBody = 8;
inline constexpr std::size_t kContentReceiptBody = 3;
inline constexpr std::size_t kWhoBody = 6;
inline constexpr std::size_t kHealthBody = 8;
inline constexpr std::size_t kClockBody = 7;
inline constexpr std::size_t kKeepBody = 8;
inline constexpr int kWhoSlots = 8;  ///< in which devices of one address answer

/// Bytes on the wire of a frame with a body of that length: delimiters, COBS, header, CRC.
[[nodiscard]] constexpr std::size_t frame_length(std::size_t body) { return 1 + 1 + 5 + body + 4 + 1; }

/// As it takes the wire, delimiters on both sides. @param frame body of at most kLongestBody bytes
[[nodiscard]] std::vector<std::uint8_t> encode(const Frame& frame);

[[nodiscard]] Frame preload(std::uint8_t address, std::uint8_t plan_byte, Sequence sequence,
                            std::span<const LookIndex> looks);
[[nodiscard]] Frame latch(std::uint8_t plan_byte, Sequence sequence);
[[nodiscard]] Frame heartbeat(std::uint8_t plan_byte, std::uint32_t show_time_ms);
[[nodiscard]] Frame lead(std::uint8_t plan_byte, std::uint32_t epoch);
[[nodiscard]] Frame status_request(std::uint8_t address, std::uint8_t plan_byte);
[[nodiscard]] Frame look_entry(std::uint8_t plan_byte, LookIndex index, const Look& look);
[[nodiscard]] Frame identify(std::uint8_t address, std::uint8_t plan_byte, bool on);
/// @param show_time at the end of the frame  @param rate of show time by the clock, 0..1.99
[[nodiscard]] Frame time(std::uint8_t plan_byte, Duration show_time, double rate);
[[nodiscard]] Frame content(std::uint8_t address, std::uint8_t plan_byte, Sequence sequence, int channel,
                            const WearableContent& content);
[[nodiscard]] Frame who(std::uint8_t address, std::uint8_t plan_byte, std::uint8_t round);
[[nodiscard]] Frame new_address(std::uint8_t address, std::uint8_t plan_byte, std::uint32_t unique_id, std::uint8_t to);
[[nodiscard]] Frame health_request(std::uint8_t address, std::uint8_t plan_byte);
[[nodiscard]] Frame clock_request(std::uint8_t address, std::uint8_t plan_byte);
/// What a node keeps: asked for, and written before.
enum class Kept : std::uint8_t { plan = 1, patch = 2 };
[[nodiscard]] Frame keep_request(std::uint8_t address, std::uint8_t plan_byte);
[[nodiscard]] Frame keep(std::uint8_t address, std::uint8_t plan_byte, Kept what, std::uint32_t check);

/// Body of a status answer.
struct NodeStatus {
  Sequence pending_sequence = 0;
  std::uint16_t crc = 0;
  std::uint8_t state = 0;
  std::uint16_t boots = 0;
  std::uint16_t dropped = 0;
};
[[nodiscard]] std::optional<NodeStatus> decode_status(const Frame& frame);
/// CRC-16 of the looks that a receipt acknowledges.
[[nodiscard]] std::optional<std::uint16_t> decode_receipt(const Frame& frame);
/// Channel and CRC-16 of the content that a receipt acknowledges.
struct ContentReceipt {
  std::uint8_t channel = 0;
  std::uint16_t crc = 0;
};
[[nodiscard]] std::optional<ContentReceipt> decode_content_receipt(const Frame& frame);
[[nodiscard]] std::optional<Identity> decode_identity(const Frame& frame);
[[nodiscard]] std::optional<std::vector<HealthValue>> decode_health(const Frame& frame);
/// What a node's clock says.
struct NodeClock {
  Duration show_time{};  ///< at the last byte of the request
  bool set = false;
  int times_taken = 0;  ///< TIME frames, modulo 256
};
[[nodiscard]] std::optional<NodeClock> decode_clock(const Frame& frame);
[[nodiscard]] std::optional<KeptChecks> decode_kept(const Frame& frame);

/// Finds frames in any bytes: in step again after the next 0x00, whatever was heard before. Never holds more than one
/// frame's length.
class FrameReceiver {
 public:
  /// @return a frame when this byte has ended one that is right in length, version, command and CRC
  std::optional<Frame> take(std::uint8_t byte);
  /// Frames that were not right, since construction; empty ones do not count.
  [[nodiscard]] std::uint32_t dropped() const { return dropped_; }
  /// Bytes since the last frame ended: somebody has begun and not ended.
  [[nodiscard]] bool midway() const { return !bytes_.empty(); }
  /// The line was quiet: what has begun will not end.
  void forget() { bytes_.clear(); }

 private:
  std::vector<std::uint8_t> bytes_;
  bool too_long_ = false;
  std::uint32_t dropped_ = 0;
};

}  // namespace footlight::drivers::footlight_serial
