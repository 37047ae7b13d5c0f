// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "core/look.hpp"
#include "drivers/driver.hpp"
#include "drivers/transport.hpp"

namespace footlight::drivers::canopen {

// Frames of docs/wire-protocol.md, section 3 (CiA 301). Pure functions; nothing here keeps state.

inline constexpr int kLastNode = 126;  ///< 127 is the controller
inline constexpr int kLooksPerRpdo = 8;

enum class NmtCommand : std::uint8_t {
  start = 0x01,
  stop = 0x02,
  pre_operational = 0x80,
  reset_node = 0x81,
  reset_communication = 0x82
};

/// @param node 1..126, or 0 for all
[[nodiscard]] CanFrame nmt(NmtCommand command, std::uint8_t node);
[[nodiscard]] CanFrame sync(Sequence counter);
/// Without a counter, as nodes expect it that have no object 0x1019.
[[nodiscard]] CanFrame plain_sync();
[[nodiscard]] CanFrame controller_heartbeat();
/// RPDO1..4 as needed. @param looks 1..32, channel 0 first
[[nodiscard]] std::vector<CanFrame> preload(std::uint8_t node, std::span<const LookIndex> looks);
/// Colour (object 0x2100), then effect and brightness (object 0x2101), to all nodes.
[[nodiscard]] std::vector<CanFrame> look_entry(LookIndex index, const Look& look);
/// Check of the plan (object 0x2105:1), to all nodes.
[[nodiscard]] CanFrame plan_check(std::uint32_t check);

/// Epoch of the controller that speaks (object 0x2106), to all nodes and to other controllers.
[[nodiscard]] CanFrame lead(std::uint32_t epoch);
/// Of a LEAD that was heard; nothing for any other frame.
[[nodiscard]] std::optional<std::uint32_t> lead_in(const CanFrame& frame);
/// EMCY of a node that has refused a LEAD.
inline constexpr std::uint16_t kFencedEmergency = 0xFF01;

/// TPDO1 of a node.
struct StatusPdo {
  std::uint8_t node = 0;
  Sequence shown_sequence = 0;
  std::uint8_t state = 0;
  std::uint16_t crc = 0;
  std::uint16_t boots = 0;
  std::uint16_t errors = 0;
};
/// NMT state of a node: 0 boot-up, 4 stopped, 5 operational, 127 pre-operational.
struct NodeHeartbeat {
  std::uint8_t node = 0;
  std::uint8_t state = 0;
};
struct Emergency {
  std::uint8_t node = 0;
  std::uint16_t code = 0;   ///< 0: the error is over
  std::uint32_t epoch = 0;  ///< kFencedEmergency: that the node follows
};
/// monostate: not a whole frame of ours.
using Heard = std::variant<std::monostate, StatusPdo, NodeHeartbeat, Emergency>;

/// Any frame is allowed; one of the wrong length or identifier is nothing.
[[nodiscard]] Heard decode(const CanFrame& frame);

/// The status PDO as it takes the wire, for budgets.
[[nodiscard]] CanFrame status_pdo_shape();

}  // namespace footlight::drivers::canopen
