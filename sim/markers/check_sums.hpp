// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace footlight::sim {

/// CRC-16/CCITT-FALSE of looks: polynomial 0x1021, start 0xFFFF, no reflection. "123456789" gives 0x29B1.
[[nodiscard]] std::uint16_t crc16_ccitt(std::span<const std::uint8_t> bytes);
/// CRC-16 of Modbus: reflected polynomial 0xA001, start 0xFFFF (Modbus over Serial Line V1.02, 6.2.2).
/// "123456789" gives 0x4B37.
[[nodiscard]] std::uint16_t crc16_modbus(std::span<const std::uint8_t> bytes);
/// CRC-32 of IEEE 802.3. "123456789" gives 0xCBF43926.
[[nodiscard]] std::uint32_t crc32_ieee(std::span<const std::uint8_t> bytes);

}  // namespace footlight::sim
