// SPDX-License-Identifier: Apache-2.0
#include "drivers/registry.hpp"

#include <array>
#include <set>
#include <string>

#include "core/check.hpp"
#include "drivers/devices/canopen/canopen_driver.hpp"
#include "drivers/devices/dmx_usb_pro/dmx_driver.hpp"
#include "drivers/devices/footlight_serial/serial_driver.hpp"
#include "drivers/devices/modbus/modbus_driver.hpp"
#include "drivers/transports/can_interface.hpp"
#include "drivers/transports/can_socket.hpp"
#include "drivers/transports/modbus_port.hpp"
#include "drivers/transports/serial_stream.hpp"
#include "drivers/transports/urls.hpp"

namespace footlight::drivers {
namespace {

using Nodes = std::vector<NodeAddress>;
constexpr int kModbusTcpPort = 502;

using DriverPointer = std::unique_ptr<Driver>;

template <class PortType>
PortType& port_of_kind(PortReference port) {
  PortType* const* pointer = std::get_if<PortType*>(&port);
  FL_CHECK(pointer != nullptr && *pointer != nullptr);
  return **pointer;
}

/// What is asked of any driver.
struct Asked {
  std::uint8_t plan_byte = 0;
  Leadership* leadership = nullptr;
};

ModbusProfile profile_of(const Bus& bus) { return bus.profile ? *bus.profile : footlight_marker_profile(); }

DriverPointer make_serial(const Bus& /*bus*/, const Nodes& nodes, const Asked& asked, PortReference port) {
  return std::make_unique<SerialDriver>(port_of_kind<ByteStream>(port), nodes, asked.plan_byte, asked.leadership);
}

DriverPointer make_canopen(const Bus& bus, const Nodes& nodes, const Asked& asked, PortReference port) {
  return std::make_unique<CanopenDriver>(port_of_kind<CanPort>(port), nodes, bus.outputs, asked.leadership);
}

DriverPointer make_modbus(const Bus& bus, const Nodes& nodes, const Asked& asked, PortReference port) {
  return std::make_unique<ModbusDriver>(port_of_kind<ModbusPort>(port), profile_of(bus), nodes, asked.plan_byte,
                                        asked.leadership);
}

/// Lamps of red, green and blue, where the rig names no fixture.
DmxFixture fixture_of(const Bus& bus) {
  return bus.fixture.value_or(DmxFixture{"dmx-rgb", {DmxSlot::red, DmxSlot::green, DmxSlot::blue}});
}

DriverPointer make_dmx(const Bus& bus, const Nodes& nodes, const Asked& /*asked*/, PortReference port) {
  return std::make_unique<DmxDriver>(port_of_kind<ByteStream>(port), fixture_of(bus), nodes);
}

struct Language {
  BusKind kind;
  int last_address;
  DriverPointer (*make)(const Bus&, const Nodes&, const Asked&, PortReference);
};

// A new language is a line here, a folder in devices/ and its sources in CMakeLists.txt.
constexpr std::array kLanguages{
    Language{BusKind::serial, 254, make_serial},     Language{BusKind::modbus_rtu, 247, make_modbus},
    Language{BusKind::modbus_tcp, 247, make_modbus}, Language{BusKind::can, canopen::kLastNode, make_canopen},
    Language{BusKind::dmx, dmx::kSlots, make_dmx},
};

/// Lamps of different nodes must not share slots.
Status<> check_slots(const Bus& bus, const Nodes& nodes) {
  const auto footprint = static_cast<int>(fixture_of(bus).slots.size());
  std::set<int> taken;
  for (const NodeAddress& node : nodes) {
    const int end = node.address + node.channels * footprint;
    const std::string what = "bus \"" + bus.name + "\": the lamps of node address " + std::to_string(node.address);
    if (end - 1 > dmx::kSlots) {
      return input_error(what + " end at slot " + std::to_string(end - 1) + " (at most " + std::to_string(dmx::kSlots) +
                         ")");
    }
    for (int slot = node.address; slot < end; ++slot) {
      if (!taken.insert(slot).second) {
        return input_error(what + " use slot " + std::to_string(slot) + ", which other lamps use as well (" +
                           std::to_string(footprint) + " slots a lamp)");
      }
    }
  }
  return Done{};
}

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

template <class PortPointer>
Result<Port> as_port(Result<PortPointer> opened) {
  if (!opened) return std::move(opened).error();
  return Port(std::move(opened).value());
}

Result<Port> open_serial_bus(const Bus& bus, const std::string& place, const Nodes& /*nodes*/) {
  return as_port(open_serial(place, SerialSettings::of(bus)));
}

Result<Port> open_rtu_bus(const Bus& bus, const std::string& place, const Nodes& /*nodes*/) {
  return as_port(open_modbus_rtu(place, SerialSettings::of(bus)));
}

Result<Port> open_tcp_bus(const Bus& /*bus*/, const std::string& place, const Nodes& nodes) {
  const auto where = parse_host_and_port(place, kModbusTcpPort);
  if (!where) return where.error();
  std::vector<std::uint8_t> units;
  for (const NodeAddress& node : nodes) units.push_back(node.unit());
  return as_port(open_modbus_tcp(where->host, where->port, std::move(units)));
}

Result<Port> open_can_bus(const Bus& bus, const std::string& place, const Nodes& /*nodes*/) {
  return as_port(open_can(place, bus.bits_per_second));
}

std::vector<Objection> preflight_can_bus(const Bus& bus, const std::string& place) {
  const auto interface = read_can_interface(place);
  // What this program was not built to see need not be wrong.
  if (!interface) return {{interface.error().message, interface.error().kind == ErrorKind::device}};
  return objections(*interface, bus.bits_per_second);
}

struct Transport {
  std::string_view scheme;
  BusKind kind;
  std::string_view example;
  Result<Port> (*open)(const Bus&, const std::string& place, const Nodes&);
  std::vector<Objection> (*preflight)(const Bus&, const std::string& place) = nullptr;
};

// A new transport is a line here and its sources in CMakeLists.txt.
constexpr std::array kTransports{
    Transport{"serial", BusKind::serial, "serial:///dev/serial/by-id/...", open_serial_bus},
    Transport{"rtu", BusKind::modbus_rtu, "rtu:///dev/serial/by-id/...", open_rtu_bus},
    Transport{"tcp", BusKind::modbus_tcp, "tcp://host:502", open_tcp_bus},
    Transport{"can", BusKind::can, "can://can0", open_can_bus, preflight_can_bus},
    Transport{"dmx", BusKind::dmx, "dmx:///dev/serial/by-id/...", open_serial_bus},
};

std::string example_for(BusKind kind) {
  for (const Transport& transport : kTransports) {
    if (transport.kind == kind) return std::string(transport.example);
  }
  return {};
}

Result<DriverPointer> make(const Bus& bus, const Nodes& nodes, const Asked& asked, PortReference port) {
  for (const Language& language : kLanguages) {
    if (language.kind != bus.kind) continue;
    const auto checked = check_nodes(bus, nodes, language.last_address);
    if (!checked) return checked.error();
    if (bus.kind == BusKind::dmx) {
      if (const auto slots = check_slots(bus, nodes); !slots) return slots.error();
    }
    return language.make(bus, nodes, asked, port);
  }
  return internal_error("bus \"" + bus.name + "\": no language for " + std::string(to_text(bus.kind)));
}

}  // namespace

PortReference reference(const Port& port) {
  return std::visit([](const auto& owned) -> PortReference { return owned.get(); }, port);
}

std::string trouble_of(const PortReference& port) {
  return std::visit([](const auto* open) { return open->trouble(); }, port);
}

std::vector<NodeAddress> node_addresses(const Rig& rig, BusIndex bus) {
  std::vector<NodeAddress> addresses;
  for (std::size_t i = 0; i < rig.nodes.size(); ++i) {
    const Node& node = rig.nodes[i];
    if (node.bus != bus) continue;
    addresses.push_back(
        {NodeIndex::of(i), static_cast<std::uint16_t>(node.address), static_cast<std::uint8_t>(node.channels.size())});
  }
  return addresses;
}

bool levels_show(const Bus& bus, const Look& look, std::span<const std::uint8_t> levels) {
  return dmx::may_show(fixture_of(bus), look, levels);
}

LookIndex shown_for(const Bus& bus, LookIndex index, const Look& look) {
  if (bus.outputs) return index != kDark && look.brightness > 0 && look.colour != Colour{} ? 1 : 0;
  return bus.profile ? modbus::value_of(*bus.profile, index, look) : index;
}

Result<DriverPointer> make_driver(const Bus& bus, const std::vector<NodeAddress>& nodes, std::uint8_t plan_byte,
                                  PortReference port) {
  return make(bus, nodes, {plan_byte, nullptr}, port);
}

Result<DriverPointer> make_leading_driver(const Bus& bus, const std::vector<NodeAddress>& nodes, std::uint8_t plan_byte,
                                          PortReference port, Leadership& leadership) {
  const bool leads = leadership.epoch != 0 && can_fence(bus);
  return make(bus, nodes, {plan_byte, leads ? &leadership : nullptr}, port);
}

bool can_fence(const Bus& bus) {
  if (bus.kind == BusKind::serial) return true;
  if (bus.kind == BusKind::can) return !bus.outputs;
  if (bus.kind != BusKind::modbus_rtu && bus.kind != BusKind::modbus_tcp) return false;
  // Our own registers have sequences and a lease; a device that knows no LEAD drops its broadcast without a word.
  const ModbusProfile profile = profile_of(bus);
  return profile.has_preload_sequence && profile.heartbeat_register && profile.has_broadcast;
}

std::vector<std::string> unfenced(const std::vector<Bus>& buses) {
  std::vector<std::string> names;
  for (const Bus& bus : buses) {
    if (!can_fence(bus)) names.push_back(bus.name);
  }
  return names;
}

std::uint8_t leading_byte(std::uint8_t plan_byte, std::uint32_t epoch) {
  return static_cast<std::uint8_t>(1 + (plan_byte + epoch % 255) % 255);
}

Result<Port> open_port(const Bus& bus, const std::vector<NodeAddress>& nodes) {
  const auto wrong = [&](const std::string& what, const std::string& hint) {
    return input_error("bus \"" + bus.name + "\": url \"" + bus.url + "\": " + what + " (" + hint + ")");
  };
  std::string examples;
  for (const Transport& transport : kTransports) {
    if (transport.scheme == scheme_of(bus.url)) {
      if (transport.kind != bus.kind)
        return wrong("not for a bus of kind " + std::string(to_text(bus.kind)), example_for(bus.kind));
      auto port = transport.open(bus, std::string(place_of(bus.url)), nodes);
      if (!port) return Error{port.error().kind, "bus \"" + bus.name + "\": " + port.error().message};
      return port;
    }
    examples += (examples.empty() ? "" : ", ") + std::string(transport.example);
  }
  if (bus.simulated()) return wrong("a simulated bus has no wire to open", examples);
  return wrong("no transport of that name", examples);
}

std::vector<Objection> preflight(const Bus& bus) {
  std::vector<Objection> found;
  for (const Transport& transport : kTransports) {
    if (transport.scheme != scheme_of(bus.url) || transport.preflight == nullptr) continue;
    for (const Objection& objection : transport.preflight(bus, std::string(place_of(bus.url)))) {
      found.push_back({"bus \"" + bus.name + "\": " + objection.text, objection.stops});
    }
  }
  return found;
}

}  // namespace footlight::drivers
