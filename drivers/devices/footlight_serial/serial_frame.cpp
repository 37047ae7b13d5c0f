// SPDX-License-Identifier: Apache-2.0
#include "drivers/devices/footlight_serial/serial_frame.hpp"

#include <algorithm>
#include <cmath>

#include <zlib.h>

#include "core/check.hpp"
#include "core/rig.hpp"
#include "drivers/devices/footlight_serial/cobs.hpp"

namespace footlight::drivers::footlight_serial {
namespace {

constexpr std::size_t kHeader = 5;
constexpr std::size_t kCheck = 4;
constexpr double kFullRate = 32'768;   // show time goes as fast as the clock
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
  if (content[1] < 1 || content[1] > static_cast<std::uint8_t>(Command::keep)) return std::nullopt;
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

Frame lead(std::uint8_t plan_byte, std::uint32_t epoch) {
  Frame frame{Direction::from_controller, Command::lead, 0, plan_byte, 0, {}};
  append_little_endian(frame.body, epoch);
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

Frame time(std::uint8_t plan_byte, Duration show_time, double rate) {
  const auto us = static_cast<std::uint64_t>(show_time / microseconds(1));
  const auto pace = static_cast<std::uint16_t>(std::clamp(std::lround(rate * kFullRate), 0L, 65'535L));
  Frame frame{Direction::from_controller, Command::time, 0, plan_byte, 0, {}};
  for (unsigned shift = 0; shift < 40; shift += 8) frame.body.push_back(static_cast<std::uint8_t>(us >> shift));
  frame.body.push_back(static_cast<std::uint8_t>(pace & 0xFFU));
  frame.body.push_back(static_cast<std::uint8_t>(pace >> 8U));
  return frame;
}

Frame content(std::uint8_t address, std::uint8_t plan_byte, Sequence sequence, int channel,
              const WearableContent& content) {
  Frame frame{Direction::from_controller, Command::content, address, plan_byte, sequence, {}};
  frame.body = {static_cast<std::uint8_t>(channel), static_cast<std::uint8_t>(content.walks ? 1 : 0), content.direction,
                static_cast<std::uint8_t>(content.distance_cm & 0xFFU),
                static_cast<std::uint8_t>(content.distance_cm >> 8U)};
  append_little_endian(frame.body, content.starts_ms);
  frame.body.push_back(static_cast<std::uint8_t>(content.count_ms & 0xFFU));
  frame.body.push_back(static_cast<std::uint8_t>(content.count_ms >> 8U));
  return frame;
}

Frame who(std::uint8_t address, std::uint8_t plan_byte, std::uint8_t round) {
  return {Direction::from_controller, Command::who, address, plan_byte, 0, {round}};
}

Frame new_address(std::uint8_t address, std::uint8_t plan_byte, std::uint32_t unique_id, std::uint8_t to) {
  Frame frame{Direction::from_controller, Command::address, address, plan_byte, 0, {}};
  append_little_endian(frame.body, unique_id);
  frame.body.push_back(to);
  frame.body.push_back(static_cast<std::uint8_t>(to ^ kGuard));
  return frame;
}

Frame health_request(std::uint8_t address, std::uint8_t plan_byte) {
  return {Direction::from_controller, Command::health, address, plan_byte, 0, {}};
}

Frame clock_request(std::uint8_t address, std::uint8_t plan_byte) {
  return {Direction::from_controller, Command::clock, address, plan_byte, 0, {}};
}

Frame keep_request(std::uint8_t address, std::uint8_t plan_byte) {
  return {Direction::from_controller, Command::keep, address, plan_byte, 0, {}};
}

Frame keep(std::uint8_t address, std::uint8_t plan_byte, Kept what, std::uint32_t check) {
  Frame frame{Direction::from_controller, Command::keep, address, plan_byte, 0, {static_cast<std::uint8_t>(what)}};
  append_little_endian(frame.body, check);
  return frame;
}

std::optional<KeptChecks> decode_kept(const Frame& frame) {
  if (frame.direction != Direction::from_node || frame.command != Command::keep) return std::nullopt;
  if (frame.body.size() != kKeepBody) return std::nullopt;
  const auto word = [&](std::size_t at) {
    return little_endian(frame.body, at) | (std::uint32_t{little_endian(frame.body, at + 2)} << 16U);
  };
  return KeptChecks{word(0), word(4)};
}

std::optional<ContentReceipt> decode_content_receipt(const Frame& frame) {
  if (frame.direction != Direction::from_node || frame.command != Command::content) return std::nullopt;
  if (frame.body.size() != kContentReceiptBody) return std::nullopt;
  return ContentReceipt{frame.body[0], little_endian(frame.body, 1)};
}

std::optional<Identity> decode_identity(const Frame& frame) {
  const bool tells = frame.command == Command::who || frame.command == Command::address;
  if (frame.direction != Direction::from_node || !tells || frame.body.size() != kWhoBody) return std::nullopt;
  Identity identity;
  identity.unique_id = little_endian(frame.body, 0) | (std::uint32_t{little_endian(frame.body, 2)} << 16U);
  identity.model = "footlight-serial";
  identity.firmware = frame.body[4];
  identity.channels = frame.body[5];
  return identity;
}

std::optional<NodeClock> decode_clock(const Frame& frame) {
  if (frame.direction != Direction::from_node || frame.command != Command::clock) return std::nullopt;
  if (frame.body.size() != kClockBody) return std::nullopt;
  std::int64_t us = 0;
  for (std::size_t i = 0; i < 5; ++i) us |= std::int64_t{frame.body[i]} << (8U * i);
  return NodeClock{microseconds(us), frame.body[5] == 1, frame.body[6]};
}

std::optional<std::vector<HealthValue>> decode_health(const Frame& frame) {
  if (frame.direction != Direction::from_node || frame.command != Command::health) return std::nullopt;
  if (frame.body.size() != kHealthBody) return std::nullopt;
  constexpr std::uint8_t kNoBattery = 255;
  constexpr int kZeroDegrees = 100;
  std::vector<HealthValue> values;
  if (frame.body[0] != kNoBattery) values.push_back({"battery", static_cast<double>(frame.body[0]), "%"});
  values.push_back({"supply", little_endian(frame.body, 1) / 1000.0, "V"});
  values.push_back({"temperature", static_cast<double>(frame.body[3] - kZeroDegrees), "C"});
  const std::uint32_t uptime = little_endian(frame.body, 4) | (std::uint32_t{little_endian(frame.body, 6)} << 16U);
  values.push_back({"uptime", static_cast<double>(uptime), "s"});
  return values;
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
