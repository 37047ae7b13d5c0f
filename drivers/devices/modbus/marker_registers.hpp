// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/look.hpp"
#include "core/rig.hpp"
#include "drivers/driver.hpp"

namespace footlight::drivers::modbus {

// Registers of docs/wire-protocol.md, section 4, and of other people's devices, at the numbers that a device profile
// gives (docs/device-profiles.md). Pure functions.

inline constexpr std::uint8_t kReadCoils = 0x01;
inline constexpr std::uint8_t kReadRegisters = 0x03;
inline constexpr std::uint8_t kWriteCoil = 0x05;
inline constexpr std::uint8_t kWriteRegister = 0x06;
inline constexpr std::uint8_t kWriteCoils = 0x0F;
inline constexpr std::uint8_t kWriteRegisters = 0x10;
inline constexpr int kLeadAfterHeartbeat = 2;  ///< registers between the two blocks
inline constexpr std::uint16_t kStatusRegisters = 6;
inline constexpr int kKeptAfterReaddress = 4;  ///< registers between the two blocks
inline constexpr std::uint16_t kKeptRegisters = 8;
inline constexpr std::uint16_t kNeededStatusRegisters = 4;  ///< the others are for people

/// One write as the device takes it: one request, or one for each register or coil.
using Requests = std::vector<ModbusRequest>;

/// What the device is told for a look: the look's index, or the device's own number of what it has nearest. A lamp that
/// is lit is never told to be dark, nor the other way round, where the palette has both.
[[nodiscard]] LookIndex value_of(const ModbusProfile& profile, LookIndex index, const Look& look);

/// What the device shows for a look: what it has nearest, a coil full white.
[[nodiscard]] Look nearest_look(const ModbusProfile& profile, const Look& look);

/// Sequence and plan byte (where the profile has them), then the looks. @param values 1..32, channel 0 first, each a
/// `value_of`
[[nodiscard]] Requests preload(const ModbusProfile& profile, std::uint8_t unit, std::uint8_t plan_byte,
                               Sequence sequence, std::span<const LookIndex> values);
/// The three guarded words; for a profile without preload sequence the sequence alone. @param profile with a latch
/// register
[[nodiscard]] Requests latch(const ModbusProfile& profile, std::uint8_t unit, std::uint8_t plan_byte,
                             Sequence sequence);
/// @param profile with a heartbeat register
[[nodiscard]] Requests heartbeat(const ModbusProfile& profile, std::uint8_t unit, std::uint32_t show_time_ms);
/// Epoch and plan byte of the controller, behind the heartbeat. @param profile with a heartbeat register
[[nodiscard]] Requests lead(const ModbusProfile& profile, std::uint8_t unit, std::uint8_t plan_byte,
                            std::uint32_t epoch);
/// First of the registers that outlast power-off: our own marker has them behind those by which it takes an address.
[[nodiscard]] std::optional<int> kept_register(const ModbusProfile& profile);
/// Check of the plan, or of the patch, to what is kept. @param profile with a kept_register
[[nodiscard]] Requests plan_check(const ModbusProfile& profile, std::uint8_t unit, std::uint32_t check);
[[nodiscard]] Requests patch_check(const ModbusProfile& profile, std::uint8_t unit, std::uint32_t check);
/// Of a length that no question for the status has. @param profile with a kept_register
[[nodiscard]] ModbusRequest kept_request(const ModbusProfile& profile, std::uint8_t unit);
[[nodiscard]] std::optional<KeptChecks> decode_kept(const ModbusProfile& profile,
                                                    std::span<const std::uint16_t> registers);
/// @param profile with a status register  @param count 1..6, the first registers of the block
[[nodiscard]] ModbusRequest status_request(const ModbusProfile& profile, std::uint8_t unit,
                                           std::uint16_t count = kStatusRegisters);
/// Reads the looks where they are written. @param profile with readable looks
[[nodiscard]] ModbusRequest looks_request(const ModbusProfile& profile, std::uint8_t unit, int channels);
/// What was read by `looks_request`, one value a channel; nothing when there are not as many registers as asked for.
[[nodiscard]] std::optional<std::vector<LookIndex>> decode_looks(const ModbusProfile& profile, int channels,
                                                                 std::span<const std::uint16_t> registers);
/// Upload of one look: our own block of four, or a state of the device's own table. Empty: the device has no room for
/// it, or no table.
[[nodiscard]] Requests look_entry(const ModbusProfile& profile, std::uint8_t unit, LookIndex index, const Look& look);

struct NodeStatus {
  Sequence shown_sequence = 0;
  Sequence pending_sequence = 0;
  std::uint16_t crc = 0;
  std::uint8_t state = 0;
  std::uint16_t boots = 0;
};
/// @return nothing when there are not 4..6 registers
[[nodiscard]] std::optional<NodeStatus> decode_status(std::span<const std::uint16_t> registers);

}  // namespace footlight::drivers::modbus
