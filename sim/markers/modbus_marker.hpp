// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/rig.hpp"
#include "sim/markers/node_model.hpp"

namespace footlight::sim {

/// The registers of our own marker (docs/wire-protocol.md, section 4).
[[nodiscard]] ModbusProfile footlight_profile();

/// A marker node that speaks Modbus (docs/wire-protocol.md, section 4), with the registers of a profile. Takes any
/// bytes.
class ModbusMarker {
 public:
  /// @param address 1..247  @param model borrowed
  ModbusMarker(std::uint8_t address, ModbusProfile profile, NodeModel& model)
      : address_(address), profile_(std::move(profile)), model_(model) {}

  void power_on() { dropped_ = 0; }
  /// One RTU frame, address to check sum. @return the answer, likewise; empty: silent
  std::vector<std::uint8_t> receive_rtu(std::span<const std::uint8_t> frame, Instant now);
  /// One TCP frame with its MBAP header. @return the answer, likewise; empty: silent
  std::vector<std::uint8_t> receive_tcp(std::span<const std::uint8_t> frame, Instant now);

 private:
  using Words = std::vector<std::uint16_t>;

  std::vector<std::uint8_t> answer(std::span<const std::uint8_t> request, Instant now);
  [[nodiscard]] std::vector<std::uint8_t> read(std::span<const std::uint8_t> request, Instant now) const;
  /// @return exception code, 0 when done
  std::uint8_t write(int first, const Words& values, Instant now);
  std::uint8_t write_preload(const Words& values, Instant now);
  std::uint8_t write_bare_looks(int offset, const Words& values, Instant now);
  std::uint8_t write_latch(const Words& values, Instant now);
  std::uint8_t write_look(const Words& values);
  [[nodiscard]] std::vector<LookIndex> looks_in(std::span<const std::uint16_t> values, int first_channel) const;
  [[nodiscard]] int look_registers() const;

  std::uint8_t address_;
  ModbusProfile profile_;
  NodeModel& model_;
  std::uint16_t dropped_ = 0;
};

}  // namespace footlight::sim
