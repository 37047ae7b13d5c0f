// SPDX-License-Identifier: Apache-2.0
#include "drivers/transports/modbus_port.hpp"

namespace footlight::drivers {
namespace {

constexpr int kBitsPerCharacter = 11;
constexpr std::uint8_t kReadCoils = 0x01;
constexpr std::uint8_t kReadRegisters = 0x03;
constexpr std::uint8_t kWriteCoils = 0x0F;
constexpr std::uint8_t kWriteRegisters = 0x10;
constexpr Duration kTurnaround = milliseconds(5);

std::size_t coil_bytes(std::uint16_t count) { return (std::size_t{count} + 7) / 8; }

Duration bits_time(Duration::rep bits, int bits_per_second) {
  return Duration((bits * 1'000'000'000 + bits_per_second - 1) / bits_per_second);
}

Duration characters_time(std::size_t characters, int bits_per_second) {
  return bits_time(static_cast<Duration::rep>(characters) * kBitsPerCharacter, bits_per_second);
}

}  // namespace

std::size_t rtu_request_bytes(const ModbusRequest& request) {
  if (request.function == kWriteCoils) return 9 + coil_bytes(request.count);
  return request.function == kWriteRegisters ? 9 + 2 * std::size_t{request.count} : 8;
}

std::size_t rtu_reply_bytes(const ModbusRequest& request) {
  if (request.function == kReadCoils) return 5 + coil_bytes(request.count);
  return request.function == kReadRegisters ? 5 + 2 * std::size_t{request.count} : 8;
}

Duration rtu_silence(int bits_per_second) {
  if (bits_per_second > 19'200) return microseconds(1750);
  return bits_time(Duration::rep{kBitsPerCharacter} * 7, 2 * bits_per_second);
}

Duration rtu_wire_time(const ModbusRequest& request, int bits_per_second) {
  const Duration asking = characters_time(rtu_request_bytes(request), bits_per_second) + rtu_silence(bits_per_second);
  if (request.unit == 0) return asking;
  return asking + kTurnaround + characters_time(rtu_reply_bytes(request), bits_per_second) +
         rtu_silence(bits_per_second);
}

}  // namespace footlight::drivers
