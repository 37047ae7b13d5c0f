// SPDX-License-Identifier: Apache-2.0
#include "sim/modbus_frames.hpp"

#include "core/check.hpp"
#include "sim/markers/check_sums.hpp"

namespace footlight::sim {
namespace {

using drivers::ModbusReply;
using drivers::ModbusRequest;

constexpr std::uint8_t kReadCoils = 0x01;
constexpr std::uint8_t kWriteCoil = 0x05;
constexpr std::uint8_t kWriteCoils = 0x0F;
constexpr std::uint8_t kRead = 0x03;
constexpr std::uint8_t kWriteOne = 0x06;
constexpr std::uint8_t kWriteSeveral = 0x10;
constexpr std::uint8_t kException = 0x80;

void append(std::vector<std::uint8_t>& bytes, std::size_t word) {
  bytes.push_back(static_cast<std::uint8_t>((word >> 8U) & 0xFFU));
  bytes.push_back(static_cast<std::uint8_t>(word & 0xFFU));
}

constexpr std::size_t kMostCoils = 1968;  // that one request writes

std::size_t coil_bytes(std::size_t count) { return (count + 7) / 8; }

std::uint16_t word_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint16_t>((bytes[at] << 8U) | bytes[at + 1]);
}

ModbusReply garbled(const ModbusRequest& request) {
  return {ModbusReply::Outcome::garbled, request.unit, request.function, 0, {}};
}

ModbusReply reply_of(const ModbusRequest& request, std::span<const std::uint8_t> pdu) {
  if (pdu.size() == 2 && pdu[0] == (request.function | kException)) {
    return {ModbusReply::Outcome::exception, request.unit, request.function, pdu[1], {}};
  }
  if (pdu.size() != reply_pdu_size(request) || pdu[0] != request.function) return garbled(request);
  ModbusReply reply{ModbusReply::Outcome::ok, request.unit, request.function, 0, {}};
  if (request.function == kRead) {
    if (pdu[1] != 2 * request.count) return garbled(request);
    for (std::size_t i = 0; i < request.count; ++i) reply.values.push_back(word_at(pdu, 2 + 2 * i));
  } else if (request.function == kReadCoils) {
    if (pdu[1] != coil_bytes(request.count)) return garbled(request);
    for (std::size_t i = 0; i < request.count; ++i) reply.values.push_back((pdu[2 + i / 8] >> (i % 8)) & 1U);
  } else if ((request.function == kWriteSeveral || request.function == kWriteCoils) &&
             word_at(pdu, 3) != request.values.size()) {
    return garbled(request);
  }
  return reply;
}

}  // namespace

std::vector<std::uint8_t> request_pdu(const ModbusRequest& request) {
  std::vector<std::uint8_t> pdu{request.function};
  append(pdu, request.first_register);
  switch (request.function) {
    case kReadCoils:
      FL_CHECK(request.unit != 0 && request.count >= 1 && request.count <= 2000);
      append(pdu, request.count);
      break;
    case kWriteCoils:
      FL_CHECK(!request.values.empty() && request.values.size() <= kMostCoils);
      append(pdu, request.values.size());
      pdu.push_back(static_cast<std::uint8_t>(coil_bytes(request.values.size())));
      pdu.resize(pdu.size() + coil_bytes(request.values.size()));
      for (std::size_t i = 0; i < request.values.size(); ++i) {
        if (request.values[i] != 0) pdu[6 + i / 8] = static_cast<std::uint8_t>(pdu[6 + i / 8] | (1U << (i % 8)));
      }
      break;
    case kRead:
      FL_CHECK(request.unit != 0 && request.count >= 1 && request.count <= 125);
      append(pdu, request.count);
      break;
    case kWriteCoil:
    case kWriteOne:
      FL_CHECK(request.values.size() == 1);
      append(pdu, request.values[0]);
      break;
    default:
      FL_CHECK(request.function == kWriteSeveral && !request.values.empty() && request.values.size() <= 123);
      append(pdu, request.values.size());
      pdu.push_back(static_cast<std::uint8_t>(2 * request.values.size()));
      for (const std::uint16_t value : request.values) append(pdu, value);
  }
  return pdu;
}

std::size_t reply_pdu_size(const ModbusRequest& request) {
  if (request.function == kReadCoils) return 2U + coil_bytes(request.count);
  return request.function == kRead ? 2U + 2U * request.count : 5U;
}

std::vector<std::uint8_t> rtu_frame(std::uint8_t unit, std::span<const std::uint8_t> pdu) {
  std::vector<std::uint8_t> frame;
  frame.reserve(pdu.size() + 3);
  frame.push_back(unit);
  frame.insert(frame.end(), pdu.begin(), pdu.end());
  const std::uint16_t check = crc16_modbus(frame);
  frame.push_back(static_cast<std::uint8_t>(check & 0xFFU));
  frame.push_back(static_cast<std::uint8_t>(check >> 8U));
  return frame;
}

std::optional<ModbusReply> rtu_reply(const ModbusRequest& request, std::span<const std::uint8_t> frame) {
  if (frame.size() < 4) return garbled(request);
  const auto body = frame.first(frame.size() - 2);
  const std::uint16_t check = crc16_modbus(body);
  if (frame[body.size()] != (check & 0xFFU) || frame[body.size() + 1] != (check >> 8U)) return garbled(request);
  if (frame[0] != request.unit) return std::nullopt;
  return reply_of(request, body.subspan(1));
}

std::vector<std::uint8_t> tcp_frame(std::uint16_t transaction, std::uint8_t unit, std::span<const std::uint8_t> pdu) {
  std::vector<std::uint8_t> frame;
  append(frame, transaction);
  append(frame, 0);
  append(frame, pdu.size() + 1);
  frame.push_back(unit);
  frame.insert(frame.end(), pdu.begin(), pdu.end());
  return frame;
}

std::optional<ModbusReply> tcp_reply(const ModbusRequest& request, std::uint16_t transaction,
                                     std::span<const std::uint8_t> frame) {
  if (frame.size() < 8 || word_at(frame, 2) != 0 || word_at(frame, 4) != frame.size() - 6) return garbled(request);
  if (word_at(frame, 0) != transaction || frame[6] != request.unit) return std::nullopt;
  return reply_of(request, frame.subspan(7));
}

}  // namespace footlight::sim
