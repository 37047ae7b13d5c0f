// SPDX-License-Identifier: Apache-2.0
#include "drivers/devices/modbus/marker_registers.hpp"

#include <utility>

#include "core/check.hpp"

namespace footlight::drivers::modbus {
namespace {

std::uint16_t word(unsigned high, unsigned low) { return static_cast<std::uint16_t>((high << 8U) | low); }

ModbusRequest write(std::uint8_t unit, int first, std::vector<std::uint16_t> values) {
  const auto count = static_cast<std::uint16_t>(values.size());
  return {unit, kWriteRegisters, static_cast<std::uint16_t>(first), count, std::move(values)};
}

}  // namespace

ModbusProfile footlight_marker() {
  ModbusProfile profile;
  profile.name = "footlight-marker";
  profile.look_register = 0x0000;
  profile.looks_per_register = 2;
  profile.has_preload_sequence = true;
  profile.latch_register = 0x0020;
  profile.heartbeat_register = 0x0030;
  profile.status_register = 0x0040;
  profile.look_table_register = 0x0050;
  return profile;
}

ModbusRequest preload(const ModbusProfile& profile, std::uint8_t unit, std::uint8_t plan_byte, Sequence sequence,
                      std::span<const LookIndex> looks) {
  FL_CHECK(!looks.empty() && looks.size() <= kChannelsPerNode);
  std::vector<std::uint16_t> values;
  if (profile.has_preload_sequence) values.push_back(word(plan_byte, sequence));
  if (profile.looks_per_register == 1) {
    values.insert(values.end(), looks.begin(), looks.end());
  } else {
    for (std::size_t i = 0; i < looks.size(); i += 2) {
      values.push_back(word(looks[i], i + 1 < looks.size() ? looks[i + 1] : 0U));
    }
  }
  return write(unit, profile.look_register, std::move(values));
}

ModbusRequest latch(const ModbusProfile& profile, std::uint8_t unit, std::uint8_t plan_byte, Sequence sequence) {
  FL_CHECK(profile.latch_register.has_value());
  if (!profile.has_preload_sequence) return write(unit, profile.latch_register.value(), {sequence});
  const std::uint16_t first = word(plan_byte, sequence);
  return write(unit, profile.latch_register.value(),
               {first, static_cast<std::uint16_t>(0x5A5AU ^ first), static_cast<std::uint16_t>(0xA5A5U ^ first)});
}

ModbusRequest heartbeat(const ModbusProfile& profile, std::uint8_t unit, std::uint32_t show_time_ms) {
  FL_CHECK(profile.heartbeat_register.has_value());
  return write(unit, profile.heartbeat_register.value(),
               {static_cast<std::uint16_t>(show_time_ms >> 16U), static_cast<std::uint16_t>(show_time_ms & 0xFFFFU)});
}

ModbusRequest status_request(const ModbusProfile& profile, std::uint8_t unit) {
  FL_CHECK(profile.status_register.has_value());
  return {unit, kReadRegisters, static_cast<std::uint16_t>(profile.status_register.value()), kStatusRegisters, {}};
}

ModbusRequest look_entry(const ModbusProfile& profile, std::uint8_t unit, LookIndex index, const Look& look) {
  FL_CHECK(profile.look_table_register.has_value());
  return write(unit, profile.look_table_register.value(),
               {index, word(look.colour.red, look.colour.green), word(look.colour.blue, look.brightness),
                static_cast<std::uint16_t>(look.effect)});
}

std::optional<NodeStatus> decode_status(std::span<const std::uint16_t> registers) {
  if (registers.size() != kStatusRegisters) return std::nullopt;
  return NodeStatus{static_cast<Sequence>(registers[0] >> 8U), static_cast<Sequence>(registers[0] & 0xFFU),
                    registers[1], static_cast<std::uint8_t>(registers[2] & 0xFFU), registers[3]};
}

}  // namespace footlight::drivers::modbus
