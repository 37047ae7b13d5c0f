// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/result.hpp"
#include "core/rig.hpp"
#include "drivers/driver.hpp"
#include "drivers/objection.hpp"
#include "drivers/transport.hpp"

namespace footlight::drivers {

/// A borrowed port of any kind; the port outlives the driver.
using PortReference = std::variant<ByteStream*, CanPort*, ModbusPort*>;
/// An owned port of any kind.
using Port = std::variant<std::unique_ptr<ByteStream>, std::unique_ptr<CanPort>, std::unique_ptr<ModbusPort>>;

[[nodiscard]] PortReference reference(const Port& port);
/// Why the port is down, in whole words for people; empty while it is not. Not while another thread uses it.
[[nodiscard]] std::string trouble_of(const PortReference& port);

/// The nodes of one bus as their driver wants them, in the order of the rig.
[[nodiscard]] std::vector<NodeAddress> node_addresses(const Rig& rig, BusIndex bus);

/// What a device of this bus holds in a channel that shows `look`: the index, or the device's own number.
[[nodiscard]] LookIndex shown_for(const Bus& bus, LookIndex index, const Look& look);

/// Whether the slots of a DMX lamp of this bus have levels that `look` may have, at whatever moment of its effect.
[[nodiscard]] bool levels_show(const Bus& bus, const Look& look, std::span<const std::uint8_t> levels);

/// The driver of the bus's kind (table in registry.cpp). A Modbus bus without a profile gets that of our own marker.
/// @param port of the kind that the bus needs: ByteStream for serial and DMX, CanPort for CAN, ModbusPort for both
/// Modbus kinds
///             (another kind is a programmer error)
/// Errors: ErrorKind::input for addresses or channels that the bus cannot have.
[[nodiscard]] Result<std::unique_ptr<Driver>> make_driver(const Bus& bus, const std::vector<NodeAddress>& nodes,
                                                          std::uint8_t plan_byte, PortReference port);

/// Opens the real wire that the bus's URL names: serial://, rtu://, tcp://, can://, dmx:// (table in registry.cpp).
/// @param nodes of the bus: over TCP a broadcast goes to each of them
/// Errors: ErrorKind::input for a URL that no transport takes, ErrorKind::device for what the machine refuses.
[[nodiscard]] Result<Port> open_port(const Bus& bus, const std::vector<NodeAddress>& nodes);

/// What would go wrong in a show with the real wire that the bus's URL names, as far as the machine tells without
/// opening it. Empty for simulated buses and for kinds of wire that have nothing to look at.
[[nodiscard]] std::vector<Objection> preflight(const Bus& bus);

}  // namespace footlight::drivers
