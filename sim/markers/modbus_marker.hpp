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

/// A device that speaks Modbus: our own marker (docs/wire-protocol.md, section 4), or somebody else's as its profile
/// describes it (docs/device-profiles.md). Takes any bytes. A device with numbers of its own shows those; their looks
/// are the profile's affair.
class ModbusMarker {
 public:
  /// @param address 1..247  @param model borrowed
  ModbusMarker(std::uint8_t address, ModbusProfile profile, NodeModel& model, std::uint32_t unique_id = 0)
      : address_(address), next_address_(address), unique_id_(unique_id), profile_(std::move(profile)), model_(model) {}

  void power_on() {
    dropped_ = 0;
    address_ = next_address_;
  }
  [[nodiscard]] std::uint8_t address() const { return address_; }
  /// One RTU frame, address to check sum. @return the answer, likewise; empty: silent
  std::vector<std::uint8_t> receive_rtu(std::span<const std::uint8_t> frame, Instant now);
  /// One TCP frame with its MBAP header. @return the answer, likewise; empty: silent
  std::vector<std::uint8_t> receive_tcp(std::span<const std::uint8_t> frame, Instant now);

 private:
  using Octets = std::vector<std::uint8_t>;
  using Words = std::vector<std::uint16_t>;

  Octets answer(std::span<const std::uint8_t> request, Instant now);
  [[nodiscard]] bool knows(std::uint8_t function) const;
  [[nodiscard]] Octets read(std::span<const std::uint8_t> request, Instant now) const;
  [[nodiscard]] Octets read_coils(std::span<const std::uint8_t> request) const;
  Octets write_coils(std::span<const std::uint8_t> request, Instant now);
  /// What a register holds; nothing where there is none.
  [[nodiscard]] std::optional<std::uint16_t> holds(int number, Instant now) const;
  [[nodiscard]] std::optional<std::uint16_t> look_word(int number) const;
  [[nodiscard]] std::optional<std::uint16_t> health_word(int number) const;
  [[nodiscard]] std::optional<int> kept_register() const;
  [[nodiscard]] std::uint16_t kept_word(int place) const;
  /// @return exception code, 0 when done
  std::uint8_t write(int first, const Words& values, Instant now);
  std::uint8_t write_preload(const Words& values, Instant now);
  std::uint8_t write_bare_looks(int offset, const Words& values, Instant now);
  std::uint8_t write_latch(const Words& values, Instant now);
  std::uint8_t write_look(const Words& values);
  std::optional<std::uint8_t> write_state(int first, const Words& values);
  std::uint8_t write_lead(const Words& values, Instant now);
  std::uint8_t write_kept(bool patch, const Words& values);
  std::uint8_t write_address(std::uint16_t address);
  std::uint8_t write_readdress(const Words& values);
  [[nodiscard]] std::vector<LookIndex> looks_in(std::span<const std::uint16_t> values, int first_channel) const;
  [[nodiscard]] int look_registers() const;
  [[nodiscard]] bool can_show(LookIndex look) const;

  std::uint8_t address_;
  std::uint8_t next_address_;  ///< after the answer, or the next power-on
  std::uint32_t unique_id_;
  ModbusProfile profile_;
  NodeModel& model_;
  std::uint16_t dropped_ = 0;
};

}  // namespace footlight::sim
