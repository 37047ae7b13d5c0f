// SPDX-License-Identifier: Apache-2.0
#include "drivers/transports/modbus_port.hpp"

namespace footlight::drivers {
namespace {

constexpr std::uint8_t kReadCoils = 0x01;
constexpr std::uint8_t kReadRegisters = 0x03;
constexpr std::uint8_t kWriteCoils = 0x0F;
constexpr std::uint8_t kWriteRegisters = 0x10;
constexpr Duration kTurnaround = milliseconds(5);

std::size_t coil_bytes(std::uint16_t count) { return (std::size_t{count} + 7) / 8; }

Duration bits_time(Duration::rep bits, int bits_per_second) {
  return Duration((bits * 1'000'000'000 + bits_per_second - 1) / bits_per_second);
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

Duration rtu_silence(int bits_per_second, int bits_per_character) {
  if (bits_per_second > 19'200) return microseconds(1750);
  return bits_time(Duration::rep{bits_per_character} * 7, 2 * bits_per_second);
}

Duration rtu_wire_time(const ModbusRequest& request, int bits_per_second, int bits_per_character) {
  const auto time_of = [&](std::size_t characters) {
    return bits_time(static_cast<Duration::rep>(characters) * bits_per_character, bits_per_second);
  };
  const Duration silence = rtu_silence(bits_per_second, bits_per_character);
  const Duration asking = time_of(rtu_request_bytes(request)) + silence;
  if (request.unit == 0) return asking;
  return asking + kTurnaround + time_of(rtu_reply_bytes(request)) + silence;
}

}  // namespace footlight::drivers
