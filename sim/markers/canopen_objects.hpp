// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/time.hpp"
#include "sim/markers/node_model.hpp"

namespace footlight::sim {

/// SDO abort codes (CiA 301, 7.2.4.3.17) that a marker gives; 0: none.
enum class SdoAbort : std::uint32_t {
  none = 0,
  toggle = 0x05030000,
  command = 0x05040001,
  read_only = 0x06010002,
  no_object = 0x06020000,
  not_mappable = 0x06040041,
  too_long = 0x06040042,
  length = 0x06070010,
  no_sub_index = 0x06090011,
  value = 0x06090030,
  state = 0x08000022,
};

/// What an SDO server reads and writes.
class ObjectDictionary {
 public:
  virtual ~ObjectDictionary() = default;
  /// @param bytes the object's value, least significant first, as long as its type
  [[nodiscard]] virtual SdoAbort read(std::uint16_t index, std::uint8_t sub,
                                      std::vector<std::uint8_t>& bytes) const = 0;
  virtual SdoAbort write(std::uint16_t index, std::uint8_t sub, std::span<const std::uint8_t> bytes, Instant now) = 0;
};

/// The object dictionary of a marker (docs/wire-protocol.md, section 3): what SDO reads and writes.
class CanopenObjects final : public ObjectDictionary {
 public:
  struct Counters {
    std::uint16_t errors = 0;
    std::uint8_t error_register = 0;
  };

  /// @param id 1..126  @param serial the marker's own  @param model, counters borrowed
  CanopenObjects(std::uint8_t id, std::uint32_t serial, NodeModel& model, const Counters& counters)
      : id_(id), serial_(serial), model_(model), counters_(counters) {}

  [[nodiscard]] SdoAbort read(std::uint16_t index, std::uint8_t sub, std::vector<std::uint8_t>& bytes) const override;
  SdoAbort write(std::uint16_t index, std::uint8_t sub, std::span<const std::uint8_t> bytes, Instant now) override;

 private:
  struct Value {
    SdoAbort abort = SdoAbort::none;
    std::uint32_t number = 0;
    int bytes = 0;
  };
  [[nodiscard]] Value communication(std::uint16_t index, std::uint8_t sub) const;
  [[nodiscard]] Value pdo(std::uint16_t index, std::uint8_t sub) const;
  [[nodiscard]] Value own(std::uint16_t index, std::uint8_t sub) const;
  [[nodiscard]] Value status(std::uint8_t sub) const;

  std::uint8_t id_;
  std::uint32_t serial_;
  NodeModel& model_;
  const Counters& counters_;
};

}  // namespace footlight::sim
