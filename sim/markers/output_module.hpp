// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "core/rig.hpp"
#include "sim/markers/can_node.hpp"
#include "sim/markers/nmt_state.hpp"
#include "sim/markers/node_model.hpp"
#include "sim/markers/sdo_server.hpp"

namespace footlight::sim {

/// An off-the-shelf module of digital outputs (CiA 401), as docs/wire-protocol.md, section 3, has it and as it comes
/// from its maker: RPDO1 valid, mapped to all of its outputs, acting at once (type 255); no heartbeats. What CiA 301
/// forbids it refuses: to map into a PDO that is valid or whose count is not 0, to count what is not mapped, to rename
/// a valid PDO. Everything is lost at power-off.
///
/// That the controller is silent it sees when its own heartbeat is due, so up to one of those late.
class OutputModuleNode final : public CanNode, private ObjectDictionary {
 public:
  /// @param id 1..126  @param module its outputs, vendor and product  @param model of values 0 and 1, borrowed
  OutputModuleNode(std::uint8_t id, OutputModule module, NodeModel& model, std::uint32_t serial = 0);
  OutputModuleNode(const OutputModuleNode&) = delete;  // its parts know each other
  OutputModuleNode& operator=(const OutputModuleNode&) = delete;

  void power_on() override;
  Reaction receive(const drivers::CanFrame& frame, Instant now) override;
  Duration beat(Instant now) override;
  [[nodiscard]] drivers::CanFrame heartbeat() const override;
  [[nodiscard]] drivers::CanFrame boot_up() const override;
  [[nodiscard]] drivers::CanFrame emergency() const override;
  [[nodiscard]] const drivers::CanFrame& sdo_answer() const override { return sdo_answer_; }

 private:
  /// An entry of the dictionary that is a plain number.
  struct Entry {
    std::uint32_t value = 0;
    int bytes = 1;
    bool writable = false;
  };
  using Place = std::pair<std::uint16_t, std::uint8_t>;

  [[nodiscard]] SdoAbort read(std::uint16_t index, std::uint8_t sub, std::vector<std::uint8_t>& bytes) const override;
  SdoAbort write(std::uint16_t index, std::uint8_t sub, std::span<const std::uint8_t> bytes, Instant now) override;
  [[nodiscard]] SdoAbort objection(Place place, std::uint32_t value) const;
  [[nodiscard]] std::uint32_t value_of(std::uint16_t index, std::uint8_t sub) const;
  [[nodiscard]] bool rpdo_valid() const { return (value_of(0x1400, 1) & 0x80000000U) == 0; }
  [[nodiscard]] std::uint8_t output_byte(int byte) const;

  Reaction manage(const drivers::CanFrame& frame, Instant now);
  Reaction take_pdo(const drivers::CanFrame& frame, Instant now);
  void set_output_bytes(int first, std::span<const std::uint8_t> bytes);
  void fall_back(Instant now);

  std::uint8_t id_;
  OutputModule module_;
  NodeModel& model_;
  std::uint32_t serial_;
  std::map<Place, Entry> entries_;
  std::map<std::uint16_t, std::uint8_t> highest_sub_;  ///< of objects that have sub-indices
  NmtState nmt_ = NmtState::pre_operational;
  std::uint16_t error_code_ = 0;  ///< of the emergency told last; 0: none, or it is over
  std::optional<Instant> controller_heard_;
  SdoServer sdo_;
  drivers::CanFrame sdo_answer_;
};

}  // namespace footlight::sim
