// SPDX-License-Identifier: Apache-2.0
#include "drivers/registry.hpp"

#include <gtest/gtest.h>

#include "tests/drivers/recording_ports.hpp"

namespace footlight::drivers {
namespace {

Bus bus_of(BusKind kind, std::string url = "sim://") {
  Bus bus;
  bus.name = "front";
  bus.kind = kind;
  bus.url = std::move(url);
  return bus;
}

std::string refusal_of(const Bus& bus, std::vector<NodeAddress> nodes) {
  RecordingStream serial;
  RecordingCan can;
  RecordingModbus modbus;
  PortReference port = &modbus;
  if (bus.kind == BusKind::serial) port = &serial;
  if (bus.kind == BusKind::can) port = &can;
  const auto driver = make_driver(bus, std::move(nodes), 0, port);
  return driver ? "" : driver.error().message;
}

std::string refusal_of_port(const Bus& bus) {
  const auto port = open_port(bus, {});
  return port ? "" : port.error().message;
}

TEST(Registry, EveryKindOfBusHasALanguage) {
  for (const BusKind kind : {BusKind::serial, BusKind::modbus_rtu, BusKind::modbus_tcp, BusKind::can}) {
    EXPECT_EQ(refusal_of(bus_of(kind), {{NodeIndex(0), 1, 1}, {NodeIndex(1), 126, 32}}), "") << to_text(kind);
  }
}

TEST(Registry, AddressesThatABusCannotHaveAreRefused) {
  EXPECT_EQ(refusal_of(bus_of(BusKind::can), {{NodeIndex(0), 127, 1}}),
            "bus \"front\": node address 127 does not exist on can (1..126)");
  EXPECT_EQ(refusal_of(bus_of(BusKind::modbus_rtu), {{NodeIndex(0), 248, 1}}),
            "bus \"front\": node address 248 does not exist on modbus-rtu (1..247)");
  EXPECT_EQ(refusal_of(bus_of(BusKind::serial), {{NodeIndex(0), 0, 1}}),
            "bus \"front\": node address 0 does not exist on serial (1..254)");
  EXPECT_EQ(refusal_of(bus_of(BusKind::serial), {{NodeIndex(0), 5, 1}, {NodeIndex(1), 5, 1}}),
            "bus \"front\": node address 5 is given twice (each once)");
  EXPECT_EQ(refusal_of(bus_of(BusKind::serial), {{NodeIndex(0), 5, 33}}),
            "bus \"front\": node address 5 has 33 channels (1..32)");
}

TEST(Registry, AModbusBusSpeaksItsOwnProfile) {
  Bus bus = bus_of(BusKind::modbus_rtu);
  bus.profile = ModbusProfile{};
  bus.profile->look_register = 77;
  bus.profile->latch_register = 5;
  RecordingModbus port;
  auto driver = make_driver(bus, {{NodeIndex(0), 1, 1}}, 0, &port);
  ASSERT_TRUE(driver);
  ASSERT_EQ((*driver)->preload({NodeIndex(0), 1, 1}, 1, std::vector<LookIndex>{1}, kStart), SendStatus::accepted);
  EXPECT_EQ(port.sent[0].first_register, 77);
}

TEST(Registry, NodesOfABusKeepTheirPlaceInTheRig) {
  Rig rig;
  rig.nodes.resize(3);
  rig.nodes[0].bus = BusIndex(1);
  rig.nodes[1].bus = BusIndex(0);
  rig.nodes[2].bus = BusIndex(1);
  rig.nodes[2].address = 9;
  rig.nodes[2].channels.resize(5);
  const auto nodes = node_addresses(rig, BusIndex(1));
  ASSERT_EQ(nodes.size(), 2U);
  EXPECT_EQ(nodes[1].node, NodeIndex(2));
  EXPECT_EQ(nodes[1].address, 9);
  EXPECT_EQ(nodes[1].channels, 5);
}

TEST(Registry, UrlsThatNoTransportTakesAreRefused) {
  EXPECT_EQ(refusal_of_port(bus_of(BusKind::serial, "usb://x")),
            "bus \"front\": url \"usb://x\": no transport of that name (serial:///dev/serial/by-id/..., "
            "rtu:///dev/serial/by-id/..., tcp://host:502, can://can0, dmx:///dev/serial/by-id/...)");
  EXPECT_EQ(refusal_of_port(bus_of(BusKind::can, "serial:///dev/ttyS0")),
            "bus \"front\": url \"serial:///dev/ttyS0\": not for a bus of kind can (can://can0)");
  EXPECT_EQ(refusal_of_port(bus_of(BusKind::can, "sim://can")),
            "bus \"front\": url \"sim://can\": a simulated bus has no wire to open (serial:///dev/serial/by-id/..., "
            "rtu:///dev/serial/by-id/..., tcp://host:502, can://can0, dmx:///dev/serial/by-id/...)");
  EXPECT_EQ(refusal_of_port(bus_of(BusKind::modbus_tcp, "tcp://host:0")),
            "bus \"front\": \"host:0\": the port is not a number of 1..65535 (host:502 or [IPv6 address]:502)");
}

TEST(Registry, PreflightNamesTheBusAndKindsWithoutOneHaveNothingToSay) {
  Bus bus;
  bus.name = "front";
  bus.kind = BusKind::can;
  bus.url = "can://can77";
  const auto found = preflight(bus);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].text.rfind("bus \"front\": CAN interface \"can77\": ", 0), 0U) << found[0].text;
  bus.url = "serial:///dev/null";
  EXPECT_TRUE(preflight(bus).empty());
}

}  // namespace
}  // namespace footlight::drivers
