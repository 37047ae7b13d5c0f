// SPDX-License-Identifier: Apache-2.0
#include "drivers/devices/footlight_serial/serial_frame.hpp"

#include <zlib.h>

#include "core/check.hpp"
#include "core/rig.hpp"
#include "drivers/devices/footlight_serial/cobs.hpp"

namespace footlight::drivers::footlight_serial {
namespace {

constexpr std::size_t kHeader = 5;
constexpr std::size_t kCheck = 4;
constexpr std::uint8_t kGuard = 0x5A;  // each byte of 0x5A5A5A5A xor sequence * 0x01010101 is this xor the sequence

std::uint32_t crc_32(std::span<const std::uint8_t> bytes) {
  return static_cast<std::uint32_t>(::crc32(0, bytes.data(), static_cast<uInt>(bytes.size())));
}

std::uint16_t little_endian(const std::vector<std::uint8_t>& body, std::size_t at) {
  return static_cast<std::uint16_t>(body[at] | (body[at + 1] << 8));
}

void append_little_endian(std::vector<std::uint8_t>& bytes, std::uint32_t value) {
  for (unsigned shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

std::optional<Frame> parse(std::span<const std::uint8_t> payload) {
  if (payload.size() < kHeader + kCheck || payload.size() > kHeader + kLongestBody + kCheck) return std::nullopt;
  const auto content = payload.first(payload.size() - kCheck);
  std::uint32_t check = 0;
  for (std::size_t i = 0; i < kCheck; ++i) check |= static_cast<std::uint32_t>(payload[content.size() + i]) << (8 * i);
  if (check != crc_32(content)) return std::nullopt;
  const auto direction = static_cast<Direction>(content[0]);
  if (direction != Direction::from_controller && direction != Direction::from_node) return std::nullopt;
  if (content[1] < 1 || content[1] > 6) return std::nullopt;
  return Frame{direction,  static_cast<Command>(content[1]),          content[2], content[3],
               content[4], {content.begin() + kHeader, content.end()}};
}

}  // namespace

std::vector<std::uint8_t> encode(const Frame& frame) {
  FL_CHECK(frame.body.size() <= kLongestBody);
  std::vector<std::uint8_t> payload{static_cast<std::uint8_t>(frame.direction),
                                    static_cast<std::uint8_t>(frame.command), frame.address, frame.plan_byte,
                                    frame.sequence};
  payload.insert(payload.end(), frame.body.begin(), frame.body.end());
  append_little_endian(payload, crc_32(payload));
  const std::vector<std::uint8_t> stuffed = cobs_encode(payload);
  std::vector<std::uint8_t> bytes;
  bytes.reserve(stuffed.size() + 2);
  bytes.push_back(0);
  bytes.insert(bytes.end(), stuffed.begin(), stuffed.end());
  bytes.push_back(0);
  return bytes;
}

Frame preload(std::uint8_t address, std::uint8_t plan_byte, Sequence sequence, std::span<const LookIndex> looks) {
  FL_CHECK(!looks.empty() && looks.size() <= kChannelsPerNode);
  Frame frame{Direction::from_controller, Command::preload, address, plan_byte, sequence, {0}};
  frame.body.insert(frame.body.end(), looks.begin(), looks.end());
  return frame;
}

Frame latch(std::uint8_t plan_byte, Sequence sequence) {
  const auto guard = static_cast<std::uint8_t>(kGuard ^ sequence);
  return {Direction::from_controller, Command::latch, 0, plan_byte, sequence, {guard, guard, guard, guard}};
}

Frame heartbeat(std::uint8_t plan_byte, std::uint32_t show_time_ms) {
  Frame frame{Direction::from_controller, Command::heartbeat, 0, plan_byte, 0, {}};
  append_little_endian(frame.body, show_time_ms);
  return frame;
}

Frame status_request(std::uint8_t address, std::uint8_t plan_byte) {
  return {Direction::from_controller, Command::status, address, plan_byte, 0, {}};
}

Frame look_entry(std::uint8_t plan_byte, LookIndex index, const Look& look) {
  return {Direction::from_controller,
          Command::look,
          0,
          plan_byte,
          0,
          {index, look.colour.red, look.colour.green, look.colour.blue, look.brightness,
           static_cast<std::uint8_t>(look.effect)}};
}

Frame identify(std::uint8_t address, std::uint8_t plan_byte, bool on) {
  return {
      Direction::from_controller, Command::identify, address, plan_byte, 0, {static_cast<std::uint8_t>(on ? 1 : 0)}};
}

std::optional<NodeStatus> decode_status(const Frame& frame) {
  if (frame.direction != Direction::from_node || frame.command != Command::status) return std::nullopt;
  if (frame.body.size() != kStatusBody) return std::nullopt;
  return NodeStatus{frame.body[0], little_endian(frame.body, 1), frame.body[3], little_endian(frame.body, 4),
                    little_endian(frame.body, 6)};
}

std::optional<std::uint16_t> decode_receipt(const Frame& frame) {
  if (frame.direction != Direction::from_node || frame.command != Command::preload) return std::nullopt;
  if (frame.body.size() != kReceiptBody) return std::nullopt;
  return little_endian(frame.body, 0);
}

std::optional<Frame> FrameReceiver::take(std::uint8_t byte) {
  constexpr std::size_t kLongest = frame_length(kLongestBody) - 2;
  if (byte != 0) {
    if (bytes_.size() == kLongest) {
      too_long_ = true;
    } else {
      bytes_.push_back(byte);
    }
    return std::nullopt;
  }
  if (bytes_.empty()) return std::nullopt;
  std::optional<Frame> frame;
  if (!too_long_) {
    if (const auto payload = cobs_decode(bytes_)) frame = parse(*payload);
  }
  if (!frame) ++dropped_;
  bytes_.clear();
  too_long_ = false;
  return frame;
}

}  // namespace footlight::drivers::footlight_serial
