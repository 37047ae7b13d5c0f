// SPDX-License-Identifier: Apache-2.0
#include "config/rig_file.hpp"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "config/device_profile.hpp"
#include "tests/config/show_folder.hpp"

namespace footlight::config {
namespace {

Show show_of(int columns, int rows) {
  Show show;
  show.stage.grid = Grid::make(GridKind::square, columns, rows, 1).value();
  show.performers.resize(3);
  show.performers[1].wearable = "W1";
  show.performers[2].wearable = "W2";
  return show;
}

/// Every cell that is not blocked and every wearable exactly once, addresses unique and in range, nodes in order.
void expect_complete(const Rig& rig, const Show& show, bool with_wearables) {
  std::set<CellIndex> cells;
  std::set<PerformerIndex> wearables;
  std::set<std::pair<BusIndex, int>> addresses;
  for (const Node& node : rig.nodes) {
    EXPECT_GE(node.channels.size(), 1U);
    EXPECT_LE(node.channels.size(), 32U);
    EXPECT_GE(node.address, 1);
    EXPECT_LE(node.address, last_address(rig.buses[node.bus.at()].kind));
    EXPECT_TRUE(addresses.emplace(node.bus, node.address).second);
    for (const Channel& channel : node.channels) {
      if (channel.kind == Channel::Kind::cell) {
        EXPECT_TRUE(cells.insert(channel.cell).second);
      } else {
        EXPECT_TRUE(wearables.insert(channel.performer).second);
      }
    }
  }
  EXPECT_EQ(cells.size(), static_cast<std::size_t>(show.stage.grid.size()) - show.stage.blocked.size());
  for (const CellIndex blocked : show.stage.blocked) EXPECT_FALSE(cells.contains(blocked));
  EXPECT_EQ(wearables.size(), with_wearables ? 2U : 0U);
  EXPECT_TRUE(std::is_sorted(rig.nodes.begin(), rig.nodes.end(), [](const Node& a, const Node& b) {
    return std::pair(a.bus, a.address) < std::pair(b.bus, b.address);
  }));
}

std::vector<int> nodes_of_buses(const Rig& rig) {
  std::vector<int> out(rig.buses.size());
  for (const Node& node : rig.nodes) ++out[node.bus.at()];
  return out;
}

class RigFile : public testing::Test {
 protected:
  Rig read(const std::string& text) {
    folder_.write("rig.yaml", text);
    return read_rig(folder_.path("rig.yaml").string(), show_, true, diagnostics_, files_);
  }
  Rig right(const std::string& text) {
    Rig rig = read(text);
    EXPECT_FALSE(diagnostics_.has_errors()) << diagnostics_.to_text();
    return rig;
  }
  std::string messages(const std::string& text) {
    (void)read(text);
    return folder_.without_folder(diagnostics_.to_text());
  }

  ShowFolder folder_;
  Show show_ = show_of(8, 6);
  Diagnostics diagnostics_;
  std::vector<std::string> files_;
};

constexpr const char* kBuses =
    "rig: 1\n"
    "buses:\n"
    "  - {name: can-a, url: \"can://can0\"}\n"
    "  - {name: rtu-a, kind: modbus-rtu, url: \"sim://rtu\", bits_per_second: 57600, profile: footlight-marker}\n"
    "  - {name: ser, url: \"serial:///dev/ttyUSB0\"}\n";

TEST_F(RigFile, ReadsBusesAndNodes) {
  show_.stage.blocked = {CellIndex(0)};
  const Rig rig = right(std::string(kBuses) +
                        "nodes:\n"
                        "  - {bus: ser, address: 9, channels: [A1:B2, H6, {wearable: W2}]}\n"
                        "  - {name: edge, bus: can-a, address: 2, channels: C3}\n"
                        "floor: {buses: [can-a, ser], channels_per_node: 8}\n");
  ASSERT_EQ(rig.buses.size(), 3U);
  EXPECT_EQ(rig.buses[0].kind, BusKind::can);
  EXPECT_EQ(rig.buses[0].bits_per_second, 500'000);
  EXPECT_FALSE(rig.buses[0].profile.has_value());
  EXPECT_EQ(rig.buses[1].bits_per_second, 57'600);
  EXPECT_EQ(rig.buses[1].profile, footlight_marker_profile());
  EXPECT_EQ(rig.buses[2].bits_per_second, 115'200);
  const auto nine = std::find_if(rig.nodes.begin(), rig.nodes.end(),
                                 [](const Node& n) { return n.address == 9 && n.bus == BusIndex(2); });
  ASSERT_NE(nine, rig.nodes.end());
  EXPECT_EQ(nine->name, "ser-9");
  ASSERT_EQ(nine->channels.size(), 5U) << "the blocked cell of the range has no lamp";
  EXPECT_EQ(nine->channels[0].cell, show_.stage.grid.index({1, 0}));
  EXPECT_EQ(nine->channels[1].cell, show_.stage.grid.index({0, 1}));
  EXPECT_EQ(nine->channels[4].performer, PerformerIndex(2));
  expect_complete(rig, show_, true);
  EXPECT_TRUE(diagnostics_.empty());
}

TEST_F(RigFile, AChannelMayBeUnused) {
  const Rig rig = right(std::string(kBuses) +
                        "nodes:\n"
                        "  - {bus: ser, address: 9, channels: [unused, A1:B1, unused]}\n"
                        "floor: {buses: [can-a]}\n");
  const auto nine = std::find_if(rig.nodes.begin(), rig.nodes.end(), [](const Node& n) { return n.address == 9; });
  ASSERT_NE(nine, rig.nodes.end());
  ASSERT_EQ(nine->channels.size(), 4U);
  EXPECT_EQ(nine->channels[0].kind, Channel::Kind::unused);
  EXPECT_EQ(nine->channels[1].cell, show_.stage.grid.index({0, 0}));
  EXPECT_EQ(nine->channels[3].kind, Channel::Kind::unused);
}

TEST_F(RigFile, ASupplyIsTheNodesOwnOrItsBuses) {
  const Rig rig = right(
      "rig: 1\nbuses:\n  - {name: a, url: \"sim://can\", supply: left}\n  - {name: b, url: \"sim://can\"}\n"
      "nodes:\n  - {bus: a, address: 9, channels: A1}\n  - {bus: a, address: 10, channels: B1, supply: tower 2}\n"
      "  - {bus: b, address: 1, channels: C1}\nfloor: {buses: [a]}\n");
  std::set<std::string> supplies;
  for (const Node& node : rig.nodes) {
    const bool own = node.bus == BusIndex(0) && node.address == 10;
    EXPECT_EQ(node.supply, own ? "tower 2" : node.bus == BusIndex(0) ? "left" : "") << node.name;
    supplies.insert(node.supply);
  }
  EXPECT_EQ(supplies.size(), 3U);
  EXPECT_EQ(messages("rig: 1\nbuses: [{name: a, url: \"sim://can\", supply: []}]\nfloor: {buses: [a]}\n"),
            "rig.yaml:2:45: error: buses[0].supply: a list stands where a single value belongs\n");
}

TEST_F(RigFile, LaysAWholeFloorInAFewLines) {
  show_ = show_of(84, 48);
  const Rig rig = right(std::string(kBuses) + "floor: {buses: [can-a, rtu-a, ser], wearables: false}\n");
  EXPECT_EQ(rig.nodes.size(), 126U);
  EXPECT_EQ(nodes_of_buses(rig), (std::vector<int>{93, 12, 21}));
  expect_complete(rig, show_, false);
}

TEST_F(RigFile, RefusesAFloorThatItsBusesDoNotCarry) {
  show_ = show_of(84, 48);
  EXPECT_EQ(
      messages(std::string(kBuses) + "floor: {buses: [rtu-a, ser], wearables: false}\n"),
      "rig.yaml:6:16: error: floor.buses: 4032 lamps need 126 nodes of 32 channels, and these buses carry 44 (more "
      "buses, or a larger nodes_per_bus)\n");
}

TEST_F(RigFile, RefusesWrongNodes) {
  std::string channels;
  for (int row = 1; row <= 4; ++row) channels += "A" + std::to_string(row) + ":H" + std::to_string(row) + ", ";
  EXPECT_EQ(messages(std::string(kBuses) +
                     "nodes:\n"
                     "  - {bus: can-a, address: 1, channels: [" +
                     channels +
                     "A5]}\n"
                     "  - {bus: can-a, address: 1, channels: [B5]}\n"
                     "  - {bus: can-a, address: 127, channels: [C5]}\n"
                     "  - {bus: can-b, address: 4, channels: [D5]}\n"
                     "  - {bus: ser, address: 5, channels: [A1, I1, {wearable: W3}, {wearable: W1}, {wearable: W1}]}\n"
                     "  - {bus: ser, address: 0, channels: []}\n"),
            "rig.yaml:7:40: error: nodes[0].channels: the node has 33 channels (at most 32; give the others to another "
            "node)\n"
            "rig.yaml:8:27: error: nodes[1].address: a second node has the address 1 on the bus \"can-a\" (the first "
            "stands in line 7)\n"
            "rig.yaml:9:27: error: nodes[2].address: the address 127 is out of range (can: 1 to 126)\n"
            "rig.yaml:10:11: error: nodes[3].bus: no bus has the name \"can-b\" (did you mean \"can-a\"?)\n"
            "rig.yaml:11:39: error: nodes[4].channels[0]: the cell A1 is given a second lamp (the first stands in line "
            "7)\n"
            "rig.yaml:11:43: error: nodes[4].channels[1]: the cell I1 is off the grid (A1 to H6)\n"
            "rig.yaml:11:58: error: nodes[4].channels[2].wearable: nobody wears \"W3\" (did you mean \"W1\"?)\n"
            "rig.yaml:11:90: error: nodes[4].channels[4].wearable: the wearable \"W1\" is given a second channel (the "
            "first stands in line 11)\n"
            "rig.yaml:12:25: error: nodes[5].address: \"0\" is out of range (1 to 512)\n"
            "rig.yaml:12:38: error: nodes[5].channels: the list is empty (at least one is needed)\n");
}

TEST_F(RigFile, RefusesWrongBuses) {
  EXPECT_EQ(
      messages("rig: 1\n"
               "buses:\n"
               "  - {name: a, kind: can, url: \"serial:///dev/ttyS0\"}\n"
               "  - {name: a, url: \"sim://can\", bits_per_second: 2000000}\n"
               "  - {name: c, url: \"http://x\"}\n"
               "  - {name: d, kind: can, url: \"can://\"}\n"
               "  - {name: e, url: \"sim://rtu\", profile: nosuch}\n"
               "  - {name: f, url: \"sim://serial\", profile: footlight-marker}\n"),
      "rig.yaml:3:31: error: buses[0].url: \"serial:///dev/ttyS0\" is the URL of a serial bus, and this one is can "
      "(can://can0 or sim://can)\n"
      "rig.yaml:4:12: error: buses[1].name: a second bus has the name \"a\" (names of buses are unique)\n"
      "rig.yaml:4:50: error: buses[1].bits_per_second: \"2000000\" is out of range (can: 10000 to 1000000 "
      "bit/s)\n"
      "rig.yaml:5:20: error: buses[2].url: \"http://x\" is not the URL of a bus (serial:///dev/..., rtu:///dev/..., "
      "tcp://host:502, can://can0, dmx:///dev/..., sim://serial, sim://rtu, sim://tcp, sim://can, sim://dmx)\n"
      "rig.yaml:6:31: error: buses[3].url: \"can://\" is not the URL of a bus (can://can0 or sim://can)\n"
      "rig.yaml:7:42: error: buses[4].profile: there is no device profile \"nosuch\" (shipped profiles: "
      "cia401-32do, dmx-dimmer, dmx-rgb, footlight-marker, pick-light, relay-16; or a .yaml file beside the rig)\n"
      "rig.yaml:8:36: error: buses[5].profile: the key has no meaning here (only Modbus devices, DMX lamps "
      "and CANopen modules have a profile)\n");
}

TEST_F(RigFile, ALineHasItsCharactersAndADirection) {
  const Rig rig = right(
      "rig: 1\n"
      "buses:\n"
      "  - {name: a, url: \"rtu://usb/FT1ABC\"}\n"
      "  - {name: b, url: \"rtu:///dev/ttyS4\", characters: 8N2, direction: kernel, direction_inverted: true}\n"
      "  - {name: c, url: \"serial:///dev/ttyS5\", direction: gpio, direction_line: \"pinctrl-bcm2711:17\"}\n"
      "floor: {buses: [a, b, c]}\n");
  EXPECT_EQ(rig.buses[0].line, SerialLine{});
  EXPECT_EQ(rig.buses[0].characters(), Characters::e1);
  EXPECT_EQ(rig.buses[1].characters(), Characters::n2);
  EXPECT_EQ(rig.buses[1].line.direction, LineDirection::kernel);
  EXPECT_TRUE(rig.buses[1].line.direction_inverted);
  EXPECT_EQ(rig.buses[2].characters(), Characters::n1);
  EXPECT_EQ(rig.buses[2].line.direction_chip, "pinctrl-bcm2711");
  EXPECT_EQ(rig.buses[2].line.direction_offset, 17);
}

TEST_F(RigFile, RefusesWrongLines) {
  EXPECT_EQ(
      messages("rig: 1\n"
               "buses:\n"
               "  - {name: a, url: \"sim://can\", characters: 8N1, direction: rts}\n"
               "  - {name: b, url: \"sim://rtu\", characters: 7E1}\n"
               "  - {name: c, url: \"sim://rtu\", direction: gpio}\n"
               "  - {name: d, url: \"sim://rtu\", direction: gpio, direction_line: gpiochip0}\n"
               "  - {name: e, url: \"sim://rtu\", direction: gpio, direction_line: \"gpiochip0:x\"}\n"
               "  - {name: f, url: \"sim://rtu\", direction: rts, direction_line: \"gpiochip0:1\"}\n"
               "  - {name: g, url: \"sim://rtu\", direction: radio, direction_inverted: maybe}\n"),
      "rig.yaml:3:33: error: buses[0].characters: the key has no meaning here (only serial and modbus-rtu buses are "
      "lines)\n"
      "rig.yaml:3:50: error: buses[0].direction: the key has no meaning here (only serial and modbus-rtu buses are "
      "lines)\n"
      "rig.yaml:4:45: error: buses[1].characters: \"7E1\" is not one of the choices (did you mean \"8E1\"?)\n"
      "rig.yaml:5:44: error: buses[2].direction: no line is named (direction_line: gpiochip0:17)\n"
      "rig.yaml:6:66: error: buses[3].direction_line: \"gpiochip0\" is no GPIO line (chip and number, as "
      "gpiochip0:17)\n"
      "rig.yaml:7:66: error: buses[4].direction_line: \"gpiochip0:x\" is no GPIO line (chip and number, as "
      "gpiochip0:17)\n"
      "rig.yaml:8:49: error: buses[5].direction_line: the key has no meaning here (direction: gpio uses it)\n"
      "rig.yaml:9:44: error: buses[6].direction: \"radio\" is not one of the choices (choices: adapter, kernel, rts, "
      "gpio)\n"
      "rig.yaml:9:71: error: buses[6].direction_inverted: \"maybe\" is neither true nor false (write true or false)\n");
}

TEST_F(RigFile, WarnsOfCellsWithoutLamp) {
  EXPECT_EQ(messages(std::string(kBuses) + "nodes: [{bus: ser, address: 1, channels: [A1:D6]}]\n"),
            "rig.yaml: warning: 24 cells have no lamp, the first is E1 (people find their place there without light; "
            "floor: lays what is left)\n");
}

TEST_F(RigFile, TakesAProfileOfItsOwn) {
  folder_.write("lamp.yaml",
                "profile: 1\nname: lamp\nlook_register: 100\nlooks_per_register: 1\npreload_sequence: false\n");
  const Rig rig = right("rig: 1\nbuses: [{name: a, url: \"tcp://lamp:502\", profile: lamp.yaml}]\nfloor: {buses: a}\n");
  const ModbusProfile& profile = rig.buses[0].profile.value();
  EXPECT_EQ(profile.name, "lamp");
  EXPECT_EQ(profile.look_register, 100);
  EXPECT_EQ(profile.looks_per_register, 1);
  EXPECT_FALSE(profile.has_preload_sequence);
  EXPECT_FALSE(profile.latch_register.has_value());
  EXPECT_EQ(files_, (std::vector<std::string>{folder_.path("lamp.yaml").string()}));
}

TEST_F(RigFile, RefusesMoreLampsThanADeviceHas) {
  EXPECT_EQ(messages("rig: 1\n"
                     "buses:\n"
                     "  - {name: r, url: \"sim://rtu\", profile: relay-16}\n"
                     "  - {name: s, url: \"sim://rtu\", profile: relay-17}\n"
                     "nodes: [{bus: r, address: 1, channels: [A1:H3]}]\n"
                     "floor: {buses: r, channels_per_node: 20}\n"),
            "rig.yaml:4:42: error: buses[1].profile: there is no device profile \"relay-17\" (did you mean "
            "\"relay-16\"?; or a .yaml file beside the rig)\n"
            "rig.yaml:5:40: error: nodes[0].channels: the node has 24 channels (a device of the profile \"relay-16\" "
            "has at most 16; give the others to another node)\n"
            "rig.yaml:6:38: error: floor.channels_per_node: the devices of the bus \"r\" have fewer than 20 channels "
            "(at most 16, as the profile \"relay-16\" says)\n");
}

TEST_F(RigFile, RefusesDmxLampsThatShareSlotsOrHaveNone) {
  EXPECT_EQ(
      messages("rig: 1\n"
               "buses: [{name: d, url: \"sim://dmx\"}, {name: e, url: \"sim://dmx\", profile: dmx-dimmer}]\n"
               "nodes:\n"
               "  - {bus: d, address: 1, channels: [A1:B1]}\n"
               "  - {bus: d, address: 6, channels: [C1]}\n"
               "  - {bus: d, address: 511, channels: [D1]}\n"
               "floor: {buses: d}\n"),
      "rig.yaml:5:23: error: nodes[1].address: slot 6 is used by other lamps as well (the node in line 4; a lamp "
      "of the profile \"dmx-rgb\" has 3 slots)\n"
      "rig.yaml:6:23: error: nodes[2].address: the lamps of this node end at slot 513 (at most 512; a lamp of the "
      "profile \"dmx-rgb\" has 3 slots)\n"
      "rig.yaml:7:16: error: floor.buses: the lamps of the DMX bus \"d\" have addresses set by hand (list them "
      "under nodes)\n");
}

TEST(DeviceProfile, OfOurMarkerIsTheShippedOne) {
  const auto file = find_profile("footlight-marker", "/");
  ASSERT_TRUE(file.has_value());
  Diagnostics diagnostics;
  EXPECT_EQ(read_profile(*file, diagnostics), footlight_marker_profile()) << diagnostics.to_text();
}

TEST(DeviceProfile, IsNotFoundOutsideOfItsFolders) {
  EXPECT_EQ(find_profile("../profiles/footlight-marker", "/"), std::nullopt);
  EXPECT_EQ(find_profile("none.yaml", "/"), std::nullopt);
}

TEST(SimulatedRig, HasOneBusOfEachKindForASmallStage) {
  const Show show = show_of(8, 6);
  const Rig rig = make_simulated_rig(show);
  ASSERT_EQ(rig.buses.size(), 3U);
  EXPECT_EQ(rig.buses[0].url, "sim://can");
  EXPECT_EQ(rig.buses[1].url, "sim://rtu");
  EXPECT_EQ(rig.buses[2].url, "sim://serial");
  for (const int nodes : nodes_of_buses(rig)) EXPECT_GE(nodes, 1);
  expect_complete(rig, show, true);
}

TEST(SimulatedRig, HasAsManyBusesAsCarryWell) {
  for (const auto& [columns, rows] : {std::pair{1, 1}, {1, 2}, {84, 48}, {144, 90}, {400, 250}}) {
    Show show = show_of(columns, rows);
    if (columns > 10) show.stage.blocked = {CellIndex(3), CellIndex(17)};
    const Rig rig = make_simulated_rig(show);
    EXPECT_EQ(rig.buses.size() % 3, 0U);
    const auto nodes = nodes_of_buses(rig);
    for (std::size_t b = 0; b < nodes.size(); ++b) EXPECT_LE(nodes[b], nodes_that_carry_well(rig.buses[b].kind));
    expect_complete(rig, show, true);
  }
}

// ---- supplies

constexpr const char* kCanAndSerial =
    "rig: 1\n"
    "buses:\n"
    "  - {name: can-a, url: \"sim://can\", supply: P1}\n"
    "  - {name: ser, url: \"sim://serial\"}\n";

TEST_F(RigFile, ReadsSuppliesAndWhatLampsTake) {
  const Rig rig =
      right(std::string(kCanAndSerial) +
            "supplies:\n"
            "  - {name: P1, limit: 20 A, overload: dim, stagger: 20 ms}\n"
            "  - {name: P2, limit: 500 mA, feeds: [{bus: ser, first: 2}, {bus: can-a, first: 1, last: 1}]}\n"
            "lamps: {red: 20 mA, green: 18 mA, blue: 0.015 A, node: 10 mA}\n"
            "nodes: [{bus: ser, address: 1, channels: A1, supply: P1}]\n"
            "floor: {buses: [can-a, ser], channels_per_node: 8}\n");
  ASSERT_EQ(rig.supplies.size(), 2U);
  EXPECT_EQ(rig.supplies[0].name, "P1");
  EXPECT_DOUBLE_EQ(rig.supplies[0].limit_a, 20);
  EXPECT_EQ(rig.supplies[0].overload, Supply::Overload::dim);
  EXPECT_EQ(rig.supplies[0].stagger, milliseconds(20));
  EXPECT_DOUBLE_EQ(rig.supplies[1].limit_a, 0.5);
  EXPECT_EQ(rig.supplies[1].overload, Supply::Overload::refuse);
  EXPECT_DOUBLE_EQ(rig.currents.green_a, 0.018);
  EXPECT_DOUBLE_EQ(rig.currents.blue_a, 0.015);
  EXPECT_DOUBLE_EQ(rig.currents.node_a, 0.01);
  for (const Node& node : rig.nodes) {
    const bool on_can = node.bus == BusIndex(0);
    const bool first = node.address == 1;
    EXPECT_EQ(node.supply, on_can ? (first ? "P2" : "P1") : (first ? "P1" : "P2")) << node.name;
  }
  EXPECT_TRUE(diagnostics_.empty()) << diagnostics_.to_text();
}

TEST_F(RigFile, SaysWhatIsWrongWithSupplies) {
  EXPECT_EQ(
      messages("rig: 1\n"
               "buses:\n"
               "  - {name: can-a, url: \"sim://can\", supply: P3}\n"
               "supplies:\n"
               "  - {name: P1, limit: 0 A, overload: sometimes, stagger: 5}\n"
               "  - {name: P1, limit: 20 V}\n"
               "  - {name: P2, limit: 20 A, feeds: [{bus: can-b}, {bus: can-a, first: 7, last: 3}]}\n"
               "lamps: {red: 20 mA, lamp: 60 mA}\n"
               "nodes: [{bus: can-a, address: 1, channels: \"A1:H4\", supply: P}]\n"),
      "rig.yaml:3:45: error: buses[0].supply: no supply has the name \"P3\" (did you mean \"P1\"?)\n"
      "rig.yaml:5:23: error: supplies[0].limit: \"0 A\" is out of range (above 0, at most 1000 A)\n"
      "rig.yaml:5:38: error: supplies[0].overload: \"sometimes\" is not one of the choices (choices: refuse, dim)\n"
      "rig.yaml:5:58: error: supplies[0].stagger: \"5\" has no unit (write for example \"3.2 s\"; units: s, ms, min)\n"
      "rig.yaml:6:12: error: supplies[1].name: a second supply has the name \"P1\" (the first stands in line 5)\n"
      "rig.yaml:6:23: error: supplies[1].limit: \"V\" is not a unit of a current (write for example \"20 mA\"; units: "
      "A, mA)\n"
      "rig.yaml:7:43: error: supplies[2].feeds[0].bus: no bus has the name \"can-b\" (did you mean \"can-a\"?)\n"
      "rig.yaml:7:80: error: supplies[2].feeds[1].last: the last address is 3, and the first 7 (at least 7)\n"
      "rig.yaml:8:27: error: lamps.lamp: the lamp's current is given twice, whole and by its colours (either lamp, or "
      "red, green and blue)\n"
      "rig.yaml:9:61: error: nodes[0].supply: no supply has the name \"P\" (supplies: P1, P1, P2)\n");
}

TEST_F(RigFile, ANodeHangsOnOneSupply) {
  EXPECT_EQ(messages(std::string(kCanAndSerial) +
                     "supplies: [{name: P1, limit: 20 A}, {name: P2, limit: 2 A, feeds: [{bus: ser}]}]\n"
                     "lamps: {lamp: 60 mA}\n"
                     "nodes: [{bus: ser, address: 1, channels: \"A1:H4\", supply: P1}]\n"),
            "rig.yaml:5:68: error: supplies[1].feeds[0]: the node \"ser-1\" hangs on the supply \"P1\" already (line 7 "
            "says so)\n");
}

TEST_F(RigFile, AFeedWithoutNodesFeedsNothing) {
  EXPECT_EQ(messages(std::string(kCanAndSerial) +
                     "supplies: [{name: P1, limit: 20 A, feeds: [{bus: ser, first: 9, last: 12}]}]\n"
                     "lamps: {lamp: 60 mA}\n"
                     "nodes: [{bus: ser, address: 1, channels: \"A1:H4\"}]\n"),
            "rig.yaml:5:50: error: supplies[0].feeds[0].bus: no node of the bus \"ser\" has an address from 9 to 12 "
            "(addresses of its nodes)\n");
}

TEST_F(RigFile, SuppliesNeedToKnowWhatLampsTake) {
  EXPECT_EQ(messages(std::string(kCanAndSerial) + "supplies: [{name: P1, limit: 20 A}]\n"
                                                  "floor: {buses: [can-a, ser]}\n"),
            "rig.yaml:5:1: warning: supplies: the node \"ser-1\" hangs on no supply (its current is counted nowhere)\n"
            "rig.yaml:5:11: error: supplies: nothing says what the lamps of the bus \"can-a\" take (lamps: {red: 20 "
            "mA, green: 20 mA, blue: 20 mA, node: 10 mA}, or currents in its profile)\n");
  diagnostics_ = {};
  EXPECT_EQ(messages(std::string(kCanAndSerial) + "supplies: [{name: P1, limit: 20 A}]\n"
                                                  "lamps: {node: 5 mA}\n"
                                                  "floor: {buses: [can-a, ser]}\n"),
            "rig.yaml:6:1: error: lamps: nothing says what a lamp takes (red, green and blue, for example 20 mA each, "
            "or lamp)\n");
}

TEST_F(RigFile, WarnsOfASupplyOfNobodyAndOfNodesOfNone) {
  EXPECT_EQ(messages(std::string(kCanAndSerial) + "supplies: [{name: P1, limit: 20 A}, {name: P2, limit: 2 A}]\n"
                                                  "lamps: {lamp: 60 mA}\n"
                                                  "floor: {buses: [can-a, ser], channels_per_node: 8}\n"),
            "rig.yaml:5:1: warning: supplies: the node \"ser-1\" hangs on no supply (its current is counted nowhere)\n"
            "rig.yaml:5:37: warning: supplies[1]: nothing hangs on the supply \"P2\" (feeds, or supply of nodes and "
            "buses)\n");
}

TEST_F(RigFile, ACanBusOfModulesHasAProfile) {
  const Rig rig =
      right("rig: 1\nbuses: [{name: can-a, url: \"can://can0\", profile: cia401-32do}]\nfloor: {buses: can-a}\n");
  ASSERT_TRUE(rig.buses[0].outputs.has_value());
  EXPECT_EQ(rig.buses[0].outputs->outputs, 32);
  EXPECT_EQ(files_.size(), 1U);
  EXPECT_EQ(messages("rig: 1\nbuses: [{name: can-a, url: \"can://can0\", profile: relay-16}]\nfloor: {buses: can-a}\n"),
            FOOTLIGHT_SOURCE_DIR
            "/drivers/profiles/relay-16.yaml:1:1: error: outputs: this is the profile of a Modbus "
            "device (a CANopen module has outputs)\n");
}

}  // namespace
}  // namespace footlight::config
