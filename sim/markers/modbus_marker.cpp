// SPDX-License-Identifier: Apache-2.0
#include "sim/markers/modbus_marker.hpp"

#include <algorithm>
#include <array>

#include "sim/markers/check_sums.hpp"

namespace footlight::sim {
namespace {

constexpr std::uint8_t kIllegalFunction = 1;
constexpr std::uint8_t kIllegalAddress = 2;
constexpr std::uint8_t kIllegalValue = 3;
constexpr std::uint8_t kRead = 0x03;
constexpr std::uint8_t kWriteOne = 0x06;
constexpr std::uint8_t kWriteSeveral = 0x10;
constexpr int kStatusRegisters = 6;
constexpr int kMostRead = 125;
constexpr std::size_t kMostWritten = 123;

std::uint16_t word_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint16_t>((bytes[at] << 8U) | bytes[at + 1]);
}

void append(std::vector<std::uint8_t>& bytes, std::uint16_t word) {
  bytes.push_back(static_cast<std::uint8_t>(word >> 8U));
  bytes.push_back(static_cast<std::uint8_t>(word & 0xFFU));
}

std::vector<std::uint8_t> exception(std::uint8_t function, std::uint8_t code) {
  return {static_cast<std::uint8_t>(function | 0x80U), code};
}

bool possible(std::uint8_t sequence) { return sequence >= 1 && sequence <= kHighestSequence; }

}  // namespace

ModbusProfile footlight_profile() {
  ModbusProfile profile;
  profile.name = "footlight-marker";
  profile.look_register = 0x0000;
  profile.latch_register = 0x0020;
  profile.heartbeat_register = 0x0030;
  profile.status_register = 0x0040;
  profile.look_table_register = 0x0050;
  return profile;
}

std::vector<std::uint8_t> ModbusMarker::receive_rtu(std::span<const std::uint8_t> frame, Instant now) {
  model_.settle(now);
  if (frame.size() < 4) {
    ++dropped_;
    return {};
  }
  if (frame[0] != 0 && frame[0] != address_) return {};
  const auto body = frame.first(frame.size() - 2);
  const std::uint16_t check = crc16_modbus(body);
  if (frame[body.size()] != (check & 0xFFU) || frame[body.size() + 1] != (check >> 8U)) {
    ++dropped_;
    return {};
  }
  const auto pdu = answer(body.subspan(1), now);
  if (frame[0] == 0) return {};
  std::vector<std::uint8_t> reply;
  reply.reserve(pdu.size() + 3);
  reply.push_back(address_);
  reply.insert(reply.end(), pdu.begin(), pdu.end());
  const std::uint16_t reply_check = crc16_modbus(reply);
  reply.push_back(static_cast<std::uint8_t>(reply_check & 0xFFU));
  reply.push_back(static_cast<std::uint8_t>(reply_check >> 8U));
  return reply;
}

std::vector<std::uint8_t> ModbusMarker::receive_tcp(std::span<const std::uint8_t> frame, Instant now) {
  model_.settle(now);
  constexpr std::size_t kMbap = 7;
  if (frame.size() <= kMbap || word_at(frame, 2) != 0 || word_at(frame, 4) != frame.size() - 6 ||
      frame[6] != address_) {
    ++dropped_;
    return {};
  }
  const auto pdu = answer(frame.subspan(kMbap), now);
  std::vector<std::uint8_t> reply{frame[0], frame[1], 0, 0};
  append(reply, static_cast<std::uint16_t>(pdu.size() + 1));
  reply.push_back(address_);
  reply.insert(reply.end(), pdu.begin(), pdu.end());
  return reply;
}

std::vector<std::uint8_t> ModbusMarker::answer(std::span<const std::uint8_t> request, Instant now) {
  const std::uint8_t function = request[0];
  if (function != kRead && function != kWriteOne && function != kWriteSeveral) {
    return exception(function, kIllegalFunction);
  }
  if (request.size() < 5) return exception(function, kIllegalValue);
  if (function == kRead) return read(request, now);
  const int first = word_at(request, 1);
  Words values;
  if (function == kWriteOne) {
    if (request.size() != 5) return exception(function, kIllegalValue);
    values.push_back(word_at(request, 3));
  } else {
    const std::size_t count = word_at(request, 3);
    if (count < 1 || count > kMostWritten || request.size() != 6 + 2 * count || request[5] != 2 * count) {
      return exception(function, kIllegalValue);
    }
    for (std::size_t i = 0; i < count; ++i) values.push_back(word_at(request, 6 + 2 * i));
  }
  if (const std::uint8_t code = write(first, values, now); code != 0) return exception(function, code);
  return {request.begin(), request.begin() + 5};
}

std::vector<std::uint8_t> ModbusMarker::read(std::span<const std::uint8_t> request, Instant now) const {
  const int first = word_at(request, 1);
  const int count = word_at(request, 3);
  if (request.size() != 5 || count < 1 || count > kMostRead) return exception(kRead, kIllegalValue);
  if (!profile_.status_register || first < *profile_.status_register ||
      first + count > *profile_.status_register + kStatusRegisters) {
    return exception(kRead, kIllegalAddress);
  }
  const auto uptime = std::chrono::duration_cast<std::chrono::seconds>(now - model_.powered_on_at());
  const std::array<std::uint16_t, kStatusRegisters> status{
      static_cast<std::uint16_t>((model_.shown_sequence() << 8U) | model_.pending_sequence()),
      model_.crc(),
      static_cast<std::uint16_t>(model_.state()),
      model_.boots(),
      static_cast<std::uint16_t>(uptime.count()),
      dropped_};
  std::vector<std::uint8_t> reply{kRead, static_cast<std::uint8_t>(2 * count)};
  const int offset = first - *profile_.status_register;
  for (int i = 0; i < count; ++i) append(reply, status[static_cast<std::size_t>(offset) + static_cast<std::size_t>(i)]);
  return reply;
}

std::uint8_t ModbusMarker::write(int first, const Words& values, Instant now) {
  if (profile_.latch_register == first) return write_latch(values, now);
  if (profile_.heartbeat_register == first) {
    if (values.size() != 2) return kIllegalValue;
    model_.heartbeat(now);
    return 0;
  }
  if (profile_.look_table_register == first) return write_look(values);
  const int offset = first - profile_.look_register;
  if (profile_.has_preload_sequence) return offset == 0 ? write_preload(values, now) : kIllegalAddress;
  if (offset < 0 || offset >= look_registers()) return kIllegalAddress;
  return write_bare_looks(offset, values, now);
}

std::uint8_t ModbusMarker::write_preload(const Words& values, Instant now) {
  const auto count = static_cast<int>(values.size()) - 1;
  const auto sequence = static_cast<std::uint8_t>(values[0] & 0xFFU);
  const auto plan = static_cast<std::uint8_t>(values[0] >> 8U);
  if (count < 1 || count > look_registers() || !possible(sequence)) return kIllegalValue;
  model_.preload(sequence, plan, 0, looks_in(std::span(values).subspan(1), 0));
  if (!profile_.latch_register) model_.latch(sequence, plan, now);
  return 0;
}

std::uint8_t ModbusMarker::write_bare_looks(int offset, const Words& values, Instant now) {
  if (static_cast<int>(values.size()) > look_registers() - offset) return kIllegalValue;
  const int first_channel = offset * profile_.looks_per_register;
  model_.stage(first_channel, looks_in(values, first_channel));
  if (!profile_.latch_register) model_.take_staged(model_.shown_sequence(), now);
  return 0;
}

std::uint8_t ModbusMarker::write_latch(const Words& values, Instant now) {
  const auto sequence = static_cast<std::uint8_t>(values[0] & 0xFFU);
  const auto plan = static_cast<std::uint8_t>(values[0] >> 8U);
  if (!possible(sequence)) return kIllegalValue;
  if (!profile_.has_preload_sequence) {
    if (values.size() != 1) return kIllegalValue;
    model_.take_staged(sequence, now);
    return 0;
  }
  if (values.size() != 3 || values[1] != (values[0] ^ 0x5A5A) || values[2] != (values[0] ^ 0xA5A5)) {
    return kIllegalValue;
  }
  model_.latch(sequence, plan, now);
  return 0;
}

std::uint8_t ModbusMarker::write_look(const Words& values) {
  if (values.size() != 4 || values[0] > 0xFF || values[3] > static_cast<std::uint16_t>(Effect::count_down)) {
    return kIllegalValue;
  }
  const auto high = [](std::uint16_t word) { return static_cast<std::uint8_t>(word >> 8U); };
  const auto low = [](std::uint16_t word) { return static_cast<std::uint8_t>(word & 0xFFU); };
  const Look look{
      {high(values[1]), low(values[1]), high(values[2])}, static_cast<Effect>(low(values[3])), low(values[2])};
  return model_.set_look(low(values[0]), look) ? std::uint8_t{0} : kIllegalValue;
}

std::vector<LookIndex> ModbusMarker::looks_in(std::span<const std::uint16_t> values, int first_channel) const {
  std::vector<LookIndex> looks;
  for (const std::uint16_t value : values) {
    if (profile_.looks_per_register == 2) looks.push_back(static_cast<LookIndex>(value >> 8U));
    looks.push_back(static_cast<LookIndex>(value & 0xFFU));
  }
  const auto room = static_cast<std::size_t>(model_.channels() - first_channel);
  looks.resize(std::min(looks.size(), room));  // the unused last byte
  return looks;
}

int ModbusMarker::look_registers() const {
  return profile_.looks_per_register == 2 ? (model_.channels() + 1) / 2 : model_.channels();
}

}  // namespace footlight::sim
