// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/look.hpp"
#include "core/rig.hpp"
#include "drivers/driver.hpp"

namespace footlight::drivers::modbus {

// Registers of docs/wire-protocol.md, section 4, at the numbers that a device profile gives. Pure functions.

inline constexpr std::uint8_t kReadRegisters = 0x03;
inline constexpr std::uint8_t kWriteRegisters = 0x10;
inline constexpr std::uint16_t kStatusRegisters = 6;

/// The profile of our own marker (drivers/profiles/footlight-marker.yaml).
[[nodiscard]] ModbusProfile footlight_marker();

/// Sequence and plan byte (where the profile has them), then the looks. @param looks 1..32, channel 0 first
[[nodiscard]] ModbusRequest preload(const ModbusProfile& profile, std::uint8_t unit, std::uint8_t plan_byte,
                                    Sequence sequence, std::span<const LookIndex> looks);
/// The three guarded words; for a profile without preload sequence the sequence alone. @param profile with a latch
/// register
[[nodiscard]] ModbusRequest latch(const ModbusProfile& profile, std::uint8_t unit, std::uint8_t plan_byte,
                                  Sequence sequence);
/// @param profile with a heartbeat register
[[nodiscard]] ModbusRequest heartbeat(const ModbusProfile& profile, std::uint8_t unit, std::uint32_t show_time_ms);
/// @param profile with a status register
[[nodiscard]] ModbusRequest status_request(const ModbusProfile& profile, std::uint8_t unit);
/// @param profile with a look table
[[nodiscard]] ModbusRequest look_entry(const ModbusProfile& profile, std::uint8_t unit, LookIndex index,
                                       const Look& look);

struct NodeStatus {
  Sequence shown_sequence = 0;
  Sequence pending_sequence = 0;
  std::uint16_t crc = 0;
  std::uint8_t state = 0;
  std::uint16_t boots = 0;
};
/// @return nothing when there are not as many registers as were asked for
[[nodiscard]] std::optional<NodeStatus> decode_status(std::span<const std::uint16_t> registers);

}  // namespace footlight::drivers::modbus
