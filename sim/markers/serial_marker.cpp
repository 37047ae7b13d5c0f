// SPDX-License-Identifier: Apache-2.0
#include "sim/markers/serial_marker.hpp"

#include <array>
#include <initializer_list>
#include <optional>

#include "sim/markers/check_sums.hpp"

namespace footlight::sim {
namespace {

constexpr std::uint8_t kFromController = 0x01;
constexpr std::uint8_t kFromNode = 0x81;
constexpr std::size_t kHeader = 5;
constexpr std::size_t kCheckSum = 4;

enum Command : std::uint8_t {
  kPreload = 1,
  kLatch = 2,
  kHeartbeat = 3,
  kStatus = 4,
  kLook = 5,
  kIdentify = 6,
  kTime = 7,
  kClock = 8,
  kContent = 9,
  kWho = 10,
  kAddress = 11,
  kHealth = 12,
  kLead = 13,
  kKeep = 14
};

constexpr std::uint8_t kKeptPlan = 1;
constexpr std::uint8_t kKeptPatch = 2;
constexpr std::uint8_t kFirmware = 1;
constexpr double kFullRate = 32'768;

std::uint8_t byte_of(std::uint32_t word, unsigned index) { return static_cast<std::uint8_t>(word >> (8U * index)); }

std::uint32_t word_at(std::span<const std::uint8_t> bytes) {
  return bytes[0] | (std::uint32_t{bytes[1]} << 8U) | (std::uint32_t{bytes[2]} << 16U) |
         (std::uint32_t{bytes[3]} << 24U);
}

/// Undoes COBS in place. @return bytes left; nothing when a length code points beyond the end
std::optional<std::size_t> unstuff(std::span<std::uint8_t> bytes) {
  std::size_t from = 0;
  std::size_t to = 0;
  while (from < bytes.size()) {
    const std::size_t code = bytes[from++];
    if (from + code - 1 > bytes.size()) return std::nullopt;
    for (std::size_t i = 1; i < code; ++i) bytes[to++] = bytes[from++];
    if (code != 0xFF && from < bytes.size()) bytes[to++] = 0;
  }
  return to;
}

std::vector<std::uint8_t> frame_of(std::vector<std::uint8_t> payload) {
  const std::uint32_t check = crc32_ieee(payload);
  for (unsigned i = 0; i < kCheckSum; ++i) payload.push_back(byte_of(check, i));
  std::vector<std::uint8_t> frame{0, 0};
  std::size_t code_at = 1;
  for (const std::uint8_t byte : payload) {  // shorter than 254 bytes, so a code of 0xFF cannot be needed
    if (byte == 0) {
      frame[code_at] = static_cast<std::uint8_t>(frame.size() - code_at);
      code_at = frame.size();
      frame.push_back(0);
    } else {
      frame.push_back(byte);
    }
  }
  frame[code_at] = static_cast<std::uint8_t>(frame.size() - code_at);
  frame.push_back(0);
  return frame;
}

}  // namespace

void SerialMarker::power_on() {
  heard_size_ = 0;
  too_long_ = false;
  dropped_ = 0;
}

std::vector<std::uint8_t> SerialMarker::receive(std::span<const std::uint8_t> bytes, Instant now) {
  model_.settle(now);
  std::vector<std::uint8_t> answer;
  for (const std::uint8_t byte : bytes) {
    if (byte == 0) {
      if (auto next = end_of_frame(now); !next.empty()) answer = std::move(next);
    } else if (heard_size_ < heard_.size()) {
      heard_[heard_size_++] = byte;
    } else {
      too_long_ = true;
    }
  }
  return answer;
}

std::vector<std::uint8_t> SerialMarker::end_of_frame(Instant now) {
  const std::span<std::uint8_t> encoded = std::span(heard_).first(heard_size_);
  const bool too_long = too_long_;
  heard_size_ = 0;
  too_long_ = false;
  if (encoded.empty()) return {};
  if (too_long) return drop();
  const auto size = unstuff(encoded);
  if (!size || *size < kHeader + kCheckSum) return drop();
  const auto payload = encoded.first(*size - kCheckSum);
  // What is for others is left alone before the check sum is worked out: that is most of what a node hears.
  if (payload[0] == kFromController && payload[2] != 0 && payload[2] != address_) return {};
  if (word_at(encoded.subspan(payload.size())) != crc32_ieee(payload)) return drop();
  if (payload[0] == kFromNode) return {};
  if (payload[0] != kFromController) return drop();
  return obey(payload, now);
}

/// What a technician asks, by plan byte 0, is no show's.
bool SerialMarker::is_fenced(std::span<const std::uint8_t> payload, Instant now) const {
  switch (payload[1]) {
    case kLead:
    case kClock:
    case kWho:
    case kHealth:
      return false;
    case kStatus:
    case kIdentify:
    case kAddress:
    case kKeep:
      return payload[3] != 0 && model_.fenced(payload[3], now);
    default:
      return model_.fenced(payload[3], now);
  }
}

std::vector<std::uint8_t> SerialMarker::obey(std::span<const std::uint8_t> payload, Instant now) {
  const bool to_all = payload[2] == 0;
  const std::uint8_t plan = payload[3];
  const std::uint8_t sequence = payload[4];
  const auto body = payload.subspan(kHeader);
  answer_slot_ = 0;
  std::vector<std::uint8_t> answer;
  if (is_fenced(payload, now)) {
    if (to_all || (payload[1] != kPreload && payload[1] != kStatus && payload[1] != kContent)) return {};
    const std::uint32_t epoch = model_.epoch(now);
    return frame_of({kFromNode, kLead, address_, plan, 0, byte_of(epoch, 0), byte_of(epoch, 1), byte_of(epoch, 2),
                     byte_of(epoch, 3)});
  }
  switch (payload[1]) {
    case kPreload:
      answer = preload(payload);
      break;
    case kLatch:
      if (body.size() != 4) return drop();
      if (word_at(body) == (0x5A5A5A5AU ^ (sequence * 0x01010101U))) model_.latch(sequence, plan, now);
      break;
    case kLead:
      if (body.size() != 4) return drop();
      (void)model_.lead(word_at(body), plan, now);
      break;
    case kHeartbeat:
      if (body.size() != 4) return drop();
      model_.heartbeat(now);
      break;
    case kStatus:
      if (!body.empty()) return drop();
      answer = status(plan);
      break;
    case kLook:
      if (body.size() != 6) return drop();
      if (body[5] <= static_cast<std::uint8_t>(Effect::count_down)) {
        model_.set_look(body[0], Look{{body[1], body[2], body[3]}, static_cast<Effect>(body[5]), body[4]});
      }
      break;
    case kIdentify:
      if (body.size() != 1) return drop();
      model_.identify(body[0] != 0, now);
      answer = status(plan);
      break;
    case kTime:
      if (body.size() != 7) return drop();
      model_.set_time(now, microseconds(static_cast<std::int64_t>(word_at(body) | (std::uint64_t{body[4]} << 32U))),
                      (body[5] | (body[6] << 8U)) / kFullRate);
      break;
    case kClock:
      if (!body.empty()) return drop();
      answer = clock(plan, now);
      break;
    case kContent:
      if (body.size() != 11) return drop();
      answer = content(payload);
      break;
    case kWho:
      if (body.size() != 1) return drop();
      answer = who(plan, body[0]);
      break;
    case kAddress:
      if (body.size() != 6) return drop();
      answer = take_address(payload);
      break;
    case kKeep:
      answer = keep(payload);
      break;
    case kHealth:
      if (!body.empty()) return drop();
      answer = health(plan, now);
      break;
    default:
      break;
  }
  if (to_all) answer.clear();
  return answer;
}

std::vector<std::uint8_t> SerialMarker::content(std::span<const std::uint8_t> payload) {
  const auto body = payload.subspan(kHeader);
  const std::uint8_t sequence = payload[4];
  if (body[0] >= model_.channels() || sequence == 0 || sequence > kHighestSequence) return {};
  const auto word = [&](std::size_t at) { return static_cast<std::uint16_t>(body[at] | (body[at + 1] << 8U)); };
  model_.set_content(sequence, body[0], {(body[1] & 1U) != 0, body[2], word(3), word_at(body.subspan(5)), word(9)});
  const std::uint16_t check = crc16_ccitt(body);
  return frame_of({kFromNode, kContent, address_, payload[3], sequence, body[0], byte_of(check, 0), byte_of(check, 1)});
}

std::vector<std::uint8_t> SerialMarker::clock(std::uint8_t plan_byte, Instant now) const {
  const auto time = model_.show_time(now);
  const auto us = static_cast<std::uint64_t>(time.value_or(Duration{}) / microseconds(1));
  std::vector<std::uint8_t> payload{kFromNode, kClock, address_, plan_byte, 0};
  for (unsigned i = 0; i < 5; ++i) payload.push_back(static_cast<std::uint8_t>(us >> (8U * i)));
  payload.push_back(time ? 1 : 0);
  payload.push_back(model_.times_set());
  return frame_of(std::move(payload));
}

std::vector<std::uint8_t> SerialMarker::i_am(std::uint8_t command, std::uint8_t plan_byte) const {
  return frame_of({kFromNode, command, address_, plan_byte, 0, byte_of(unique_id_, 0), byte_of(unique_id_, 1),
                   byte_of(unique_id_, 2), byte_of(unique_id_, 3), kFirmware,
                   static_cast<std::uint8_t>(model_.channels())});
}

std::vector<std::uint8_t> SerialMarker::who(std::uint8_t plan_byte, std::uint8_t round) {
  const std::array<std::uint8_t, 5> seed{byte_of(unique_id_, 0), byte_of(unique_id_, 1), byte_of(unique_id_, 2),
                                         byte_of(unique_id_, 3), round};
  answer_slot_ = crc16_ccitt(seed) % kSlots;
  return i_am(kWho, plan_byte);
}

std::vector<std::uint8_t> SerialMarker::take_address(std::span<const std::uint8_t> payload) {
  const auto body = payload.subspan(kHeader);
  if (word_at(body) != unique_id_ || body[4] == 0 || body[4] == 255 || body[5] != (body[4] ^ 0x5A)) return {};
  auto answer = i_am(kAddress, payload[3]);
  address_ = body[4];
  return answer;
}

std::vector<std::uint8_t> SerialMarker::health(std::uint8_t plan_byte, Instant now) const {
  const auto& health = model_.health;
  const auto uptime = static_cast<std::uint32_t>(
      std::chrono::duration_cast<std::chrono::seconds>(now - model_.powered_on_at()).count());
  const auto supply = static_cast<std::uint32_t>(health.supply_mv);
  return frame_of({kFromNode, kHealth, address_, plan_byte, 0, static_cast<std::uint8_t>(health.battery_percent),
                   byte_of(supply, 0), byte_of(supply, 1), static_cast<std::uint8_t>(health.temperature_c + 100),
                   byte_of(uptime, 0), byte_of(uptime, 1), byte_of(uptime, 2), byte_of(uptime, 3)});
}

std::vector<std::uint8_t> SerialMarker::keep(std::span<const std::uint8_t> payload) {
  const auto body = payload.subspan(kHeader);
  if (!body.empty() && body.size() != 5) return drop();
  if (!body.empty() && body[0] == kKeptPlan) model_.keep_plan(word_at(body.subspan(1)));
  if (!body.empty() && body[0] == kKeptPatch) model_.keep_patch(word_at(body.subspan(1)));
  std::vector<std::uint8_t> answer{kFromNode, kKeep, address_, payload[3], 0};
  for (const std::uint32_t check : {model_.plan_check(), model_.patch_check()}) {
    for (unsigned i = 0; i < 4; ++i) answer.push_back(byte_of(check, i));
  }
  return frame_of(std::move(answer));
}

std::vector<std::uint8_t> SerialMarker::preload(std::span<const std::uint8_t> payload) {
  const std::uint8_t plan = payload[3];
  const std::uint8_t sequence = payload[4];
  const auto body = payload.subspan(kHeader);
  if (body.size() < 2) return drop();
  const auto looks = body.subspan(1);
  if (body[0] + looks.size() > static_cast<std::size_t>(model_.channels())) return {};
  if (sequence == 0 || sequence > kHighestSequence) return {};
  model_.preload(sequence, plan, body[0], looks);
  const std::uint16_t check = crc16_ccitt(looks);
  return frame_of(
      {kFromNode, kPreload, address_, plan, model_.pending_sequence(), byte_of(check, 0), byte_of(check, 1)});
}

std::vector<std::uint8_t> SerialMarker::status(std::uint8_t plan_byte) const {
  const std::uint16_t crc = model_.crc();
  return frame_of({kFromNode, kStatus, address_, plan_byte, model_.shown_sequence(), model_.pending_sequence(),
                   byte_of(crc, 0), byte_of(crc, 1), static_cast<std::uint8_t>(model_.state()),
                   byte_of(model_.boots(), 0), byte_of(model_.boots(), 1), byte_of(dropped_, 0), byte_of(dropped_, 1)});
}

}  // namespace footlight::sim
