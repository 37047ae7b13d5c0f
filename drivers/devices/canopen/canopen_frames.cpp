// SPDX-License-Identifier: Apache-2.0
#include "drivers/devices/canopen/canopen_frames.hpp"

#include <algorithm>
#include <initializer_list>

#include "core/check.hpp"
#include "core/rig.hpp"

namespace footlight::drivers::canopen {
namespace {

constexpr std::uint16_t kNmt = 0x000;
constexpr std::uint16_t kSync = 0x080;
constexpr std::uint16_t kEmergency = 0x080;
constexpr std::uint16_t kStatus = 0x180;
constexpr std::uint16_t kFirstRpdo = 0x200;
constexpr std::uint16_t kRpdoStride = 0x100;
constexpr std::uint16_t kMultiplexed = 0x1FF;
constexpr std::uint16_t kHeartbeat = 0x700;
constexpr std::uint16_t kControllerHeartbeat = 0x77F;
constexpr std::uint8_t kToAllNodes = 0x80;  // destination address mode, node 0
constexpr std::uint8_t kOperational = 5;

CanFrame frame_of(std::uint16_t id, std::initializer_list<std::uint8_t> data) {
  CanFrame frame;
  frame.id = id;
  frame.length = static_cast<std::uint8_t>(data.size());
  std::copy(data.begin(), data.end(), frame.data.begin());
  return frame;
}

std::uint16_t little_endian(const CanFrame& frame, std::size_t at) {
  return static_cast<std::uint16_t>(frame.data[at] | (frame.data[at + 1] << 8));
}

}  // namespace

CanFrame nmt(NmtCommand command, std::uint8_t node) {
  return frame_of(kNmt, {static_cast<std::uint8_t>(command), node});
}

CanFrame sync(Sequence counter) { return frame_of(kSync, {counter}); }

CanFrame plain_sync() { return frame_of(kSync, {}); }

CanFrame controller_heartbeat() { return frame_of(kControllerHeartbeat, {kOperational}); }

std::vector<CanFrame> preload(std::uint8_t node, std::span<const LookIndex> looks) {
  FL_CHECK(node >= 1 && node <= kLastNode);
  FL_CHECK(!looks.empty() && looks.size() <= kChannelsPerNode);
  std::vector<CanFrame> frames;
  for (std::size_t first = 0; first < looks.size(); first += kLooksPerRpdo) {
    CanFrame frame;
    frame.id = static_cast<std::uint16_t>(kFirstRpdo + kRpdoStride * frames.size() + node);
    const auto part = looks.subspan(first, std::min<std::size_t>(kLooksPerRpdo, looks.size() - first));
    frame.length = static_cast<std::uint8_t>(part.size());
    std::copy(part.begin(), part.end(), frame.data.begin());
    frames.push_back(frame);
  }
  return frames;
}

std::vector<CanFrame> look_entry(LookIndex index, const Look& look) {
  return {
      frame_of(kMultiplexed, {kToAllNodes, 0x00, 0x21, index, look.colour.blue, look.colour.green, look.colour.red, 0}),
      frame_of(kMultiplexed,
               {kToAllNodes, 0x01, 0x21, index, static_cast<std::uint8_t>(look.effect), look.brightness, 0, 0})};
}

CanFrame plan_check(std::uint32_t check) {
  const auto byte = [&](unsigned i) { return static_cast<std::uint8_t>(check >> (8U * i)); };
  return frame_of(kMultiplexed, {kToAllNodes, 0x05, 0x21, 1, byte(0), byte(1), byte(2), byte(3)});
}

CanFrame lead(std::uint32_t epoch) {
  const auto byte = [&](unsigned i) { return static_cast<std::uint8_t>(epoch >> (8U * i)); };
  return frame_of(kMultiplexed, {kToAllNodes, 0x06, 0x21, 0, byte(0), byte(1), byte(2), byte(3)});
}

std::optional<std::uint32_t> lead_in(const CanFrame& frame) {
  const auto& data = frame.data;
  if (frame.kind != CanFrame::Kind::classic || frame.id != kMultiplexed || frame.length != 8) return std::nullopt;
  if (data[0] != kToAllNodes || data[1] != 0x06 || data[2] != 0x21 || data[3] != 0) return std::nullopt;
  return little_endian(frame, 4) | (std::uint32_t{little_endian(frame, 6)} << 16U);
}

Heard decode(const CanFrame& frame) {
  const auto node = static_cast<std::uint8_t>(frame.id & 0x7FU);
  if (frame.kind != CanFrame::Kind::classic || frame.id > 0x7FF || node < 1 || node > kLastNode) return {};
  switch (frame.id - node) {
    case kEmergency:
      if (frame.length != 8) return {};
      return Emergency{node, little_endian(frame, 0),
                       little_endian(frame, 3) | (std::uint32_t{little_endian(frame, 5)} << 16U)};
    case kStatus:
      if (frame.length != 8) return {};
      return StatusPdo{node,
                       frame.data[0],
                       frame.data[1],
                       little_endian(frame, 2),
                       little_endian(frame, 4),
                       little_endian(frame, 6)};
    case kHeartbeat:
      if (frame.length != 1) return {};
      return NodeHeartbeat{node, frame.data[0]};
    default:
      return {};
  }
}

CanFrame status_pdo_shape() { return frame_of(kStatus + 1, {0, 0, 0, 0, 0, 0, 0, 0}); }

}  // namespace footlight::drivers::canopen
