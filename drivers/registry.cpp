// SPDX-License-Identifier: Apache-2.0
#include "drivers/registry.hpp"

#include <array>
#include <set>
#include <string>

#include "core/check.hpp"
#include "drivers/devices/canopen/canopen_driver.hpp"
#include "drivers/devices/footlight_serial/serial_driver.hpp"
#include "drivers/devices/modbus/modbus_driver.hpp"

namespace footlight::drivers {
namespace {

using Nodes = std::vector<NodeAddress>;
using DriverPointer = std::unique_ptr<Driver>;

template <class PortType>
PortType& port_of_kind(PortReference port) {
  PortType* const* pointer = std::get_if<PortType*>(&port);
  FL_CHECK(pointer != nullptr && *pointer != nullptr);
  return **pointer;
}

DriverPointer make_serial(const Bus& /*bus*/, const Nodes& nodes, std::uint8_t plan_byte, PortReference port) {
  return std::make_unique<SerialDriver>(port_of_kind<ByteStream>(port), nodes, plan_byte);
}

DriverPointer make_canopen(const Bus& /*bus*/, const Nodes& nodes, std::uint8_t /*plan_byte*/, PortReference port) {
  return std::make_unique<CanopenDriver>(port_of_kind<CanPort>(port), nodes);
}

template <ModbusDriver::Line line>
DriverPointer make_modbus(const Bus& bus, const Nodes& nodes, std::uint8_t plan_byte, PortReference port) {
  const ModbusProfile profile = bus.profile ? *bus.profile : modbus::footlight_marker();
  return std::make_unique<ModbusDriver>(port_of_kind<ModbusPort>(port), line, profile, nodes, plan_byte);
}

struct Language {
  BusKind kind;
  int last_address;
  DriverPointer (*make)(const Bus&, const Nodes&, std::uint8_t, PortReference);
};

// A new language is a line here, a folder in devices/ and its sources in CMakeLists.txt.
constexpr std::array kLanguages{
    Language{BusKind::serial, 254, make_serial},
    Language{BusKind::modbus_rtu, 247, make_modbus<ModbusDriver::Line::rtu>},
    Language{BusKind::modbus_tcp, 247, make_modbus<ModbusDriver::Line::tcp>},
    Language{BusKind::can, canopen::kLastNode, make_canopen},
};

Status<> check_nodes(const Bus& bus, const Nodes& nodes, int last_address) {
  std::set<int> seen;
  const std::string what = "bus \"" + bus.name + "\": node address ";
  for (const NodeAddress& node : nodes) {
    const std::string address = std::to_string(node.address);
    if (node.address < 1 || node.address > last_address) {
      return input_error(what + address + " does not exist on " + std::string(to_text(bus.kind)) + " (1.." +
                         std::to_string(last_address) + ")");
    }
    if (!seen.insert(node.address).second) return input_error(what + address + " is given twice (each once)");
    if (node.channels < 1 || node.channels > kChannelsPerNode) {
      return input_error(what + address + " has " + std::to_string(node.channels) + " channels (1.." +
                         std::to_string(kChannelsPerNode) + ")");
    }
  }
  return Done{};
}

}  // namespace

PortReference reference(const Port& port) {
  return std::visit([](const auto& owned) -> PortReference { return owned.get(); }, port);
}

std::vector<NodeAddress> node_addresses(const Rig& rig, BusIndex bus) {
  std::vector<NodeAddress> addresses;
  for (std::size_t i = 0; i < rig.nodes.size(); ++i) {
    const Node& node = rig.nodes[i];
    if (node.bus != bus) continue;
    addresses.push_back(
        {NodeIndex::of(i), static_cast<std::uint8_t>(node.address), static_cast<std::uint8_t>(node.channels.size())});
  }
  return addresses;
}

Result<DriverPointer> make_driver(const Bus& bus, std::vector<NodeAddress> nodes, std::uint8_t plan_byte,
                                  PortReference port) {
  for (const Language& language : kLanguages) {
    if (language.kind != bus.kind) continue;
    const auto checked = check_nodes(bus, nodes, language.last_address);
    if (!checked) return checked.error();
    return language.make(bus, nodes, plan_byte, port);
  }
  return internal_error("bus \"" + bus.name + "\": no language for " + std::string(to_text(bus.kind)));
}

}  // namespace footlight::drivers
