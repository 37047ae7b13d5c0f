// SPDX-License-Identifier: Apache-2.0
// The program itself on a CAN interface of the kernel: `footlight sim` on one side, `footlight run`, `footlight
// devices` and can-utils on the other.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/hardware/guest.hpp"

namespace footlight::hardware {
namespace {

using Json = nlohmann::json;

constexpr const char* kProgram = FOOTLIGHT_PROGRAM;
constexpr std::size_t kNodes = 12;  // a row of the stage each

constexpr const char* kShow = R"(footlight: 1
title: Twelve
stage:
  grid: {kind: square, columns: 12, rows: 8, pitch: 1 m}
  clearance: 0.5 m
  max_speed: 4 m/s
performers: {count: 12}
music: {tempo: 240, meter: 4/4}
sections:
  - {name: line, from: {cells: line.csv}, start: count 1, hold: 2 counts}
  - {name: ring, from: {cells: ring.csv}, start: count 13, hold: 2 counts}
cues:
  - {number: "1", section: line}
  - {number: "2", section: ring}
announce: 2 counts
rig: rig.yaml
)";
constexpr const char* kRig = R"(rig: 1
buses: [{name: far, kind: can, url: 'can://vcan0'}]
floor: {buses: [far], channels_per_node: 8}
)";

std::string text_of(const std::string& file) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// The markers of a small show, served by the program on a virtual CAN bus.
class ProgramOnVcan : public ::testing::Test {
 protected:
  ProgramOnVcan() {
    run("ip link add vcan0 type vcan && ip link set vcan0 txqueuelen 100 && ip link set vcan0 up");
    run("rm -rf s sim.jsonl; " + program("new s"));
    std::ofstream("s/show.yaml") << kShow;
    std::ofstream("s/rig.yaml") << kRig;
    run(program("sim s/show.yaml --can far=vcan0 --dir ports --json >sim.jsonl 2>sim.err & echo $! >sim.pid"));
    EXPECT_TRUE(eventually([] { return text_of("sim.jsonl").ends_with("\n"); }, seconds(30))) << text_of("sim.err");
  }
  ~ProgramOnVcan() override { run("kill -KILL $(cat sim.pid) 2>/dev/null; ip link del vcan0"); }
  static std::string program(const std::string& arguments) { return std::string(kProgram) + " " + arguments; }

  /// What a command of the program says for other programs.
  static Json json_of(const std::string& arguments) {
    run("(" + program(arguments) + " --json >out.json 2>err.txt || { cat err.txt out.json; false; })");
    return Json::parse(text_of("out.json"), nullptr, false);
  }

  /// What `sim` has said so far, a line for each lamp that changed; the first says where the buses are.
  static std::vector<Json> lines() {
    std::vector<Json> all;
    std::istringstream text(text_of("sim.jsonl"));
    for (std::string line; std::getline(text, line);) {
      Json parsed = Json::parse(line, nullptr, false);
      if (!parsed.is_discarded()) all.push_back(std::move(parsed));  // the last may be half written
    }
    return all;
  }
  static bool lamp_showed(const std::string& node, int channel, int look) {
    const auto all = lines();
    return std::any_of(all.begin(), all.end(), [&](const Json& line) {
      return line.value("node", "") == node && line.value("channel", -1) == channel && line.value("look", -1) == look;
    });
  }
  /// Ends the simulation. @return what every lamp shows: by node, by channel
  static std::map<std::string, std::map<int, int>> end_of_sim() {
    run("kill -INT $(cat sim.pid)");
    EXPECT_TRUE(eventually([] { return lines().back().contains("floor"); }));
    std::map<std::string, std::map<int, int>> floor;
    const std::vector<Json> all = lines();
    for (const Json& node : all.back()["floor"]) {
      for (const auto& [channel, look] : node["looks"].items()) {
        floor[node["node"].get<std::string>()][std::stoi(channel)] = look.get<int>();
      }
    }
    return floor;
  }
};

TEST_F(ProgramOnVcan, RunPlaysAWholeShowAgainstSimAndEveryLampIsRight) {
  const Json report = json_of("run s/show.yaml --go --state state");
  EXPECT_EQ(report["unconfirmed"], 0) << report.dump(1);
  EXPECT_GT(report["buses"][0]["deliveries"].get<int>(), 0);
  EXPECT_EQ(report["cues"].size(), 2U);
  auto shown = end_of_sim();
  ASSERT_EQ(shown.size(), kNodes);
  int lit = 0;
  for (const Json& node : report["floor"]) {
    const auto& lamps = shown[node["node"].get<std::string>()];
    ASSERT_EQ(lamps.size(), node["looks"].size());
    for (const auto& [channel, look] : lamps) {
      EXPECT_EQ(look, node["looks"][static_cast<std::size_t>(channel)].get<int>()) << node["node"] << " " << channel;
      lit += look != 0 && look != 255 ? 1 : 0;
    }
  }
  EXPECT_GE(lit, 12) << "twelve people stand somewhere";
}

TEST_F(ProgramOnVcan, CansendLightsALampAndCandumpHearsTheMarker) {
  run("stdbuf -oL candump -L vcan0 >candump.log & echo $! >candump.pid");
  EXPECT_TRUE(eventually([] { return text_of("candump.log").find("vcan0 701#7F") != std::string::npos; }))
      << "a heartbeat, pre-operational";
  run("cansend vcan0 000#0101");              // NMT start of node 1
  run("cansend vcan0 201#0A0B0C0D0E0F1011");  // RPDO1
  run("cansend vcan0 080#05");                // SYNC
  EXPECT_TRUE(eventually([] { return lamp_showed("far-1", 7, 0x11); })) << text_of("sim.jsonl");
  EXPECT_TRUE(eventually([] { return text_of("candump.log").find("vcan0 181#05") != std::string::npos; }))
      << "its status, by TPDO1";
  run("cansend vcan0 601#4018100200000000");  // SDO: product code
  EXPECT_TRUE(eventually([] { return text_of("candump.log").find("vcan0 581#431810024B4D4C46") != std::string::npos; }))
      << text_of("candump.log");
  run("kill $(cat candump.pid)");
  EXPECT_EQ(end_of_sim()["far-1"][0], 0x0A);
}

TEST_F(ProgramOnVcan, ATechnicianFindsIdentifiesAndAsksTheMarkers) {
  const Json scan = json_of("devices scan can://vcan0 --addresses 1-14");
  ASSERT_EQ(scan["found"].size(), kNodes) << scan.dump(1);
  for (const Json& node : scan["found"]) {
    EXPECT_EQ(node["is"], "present");
    EXPECT_EQ(node["identities"][0]["model"], "Footlight marker");
    EXPECT_EQ(node["identities"][0]["channels"], 8);
  }
  const Json health = json_of("devices health far --show s/show.yaml");
  ASSERT_EQ(health["nodes"].size(), kNodes);
  for (const Json& node : health["nodes"]) EXPECT_EQ(node["answered"], 1) << node.dump();
  const Json tested = json_of("devices test far --show s/show.yaml --duration 1s");
  for (const Json& node : tested["nodes"]) EXPECT_GT(node["answered"], 0) << node.dump();
  run(program("devices identify far-3 --show s/show.yaml"));
  EXPECT_TRUE(eventually([] {
    const auto all = lines();
    return std::any_of(all.begin(), all.end(), [](const Json& line) {
      return line.value("node", "") == "far-3" && line.value("colour", "") == "#FFFFFF";
    });
  })) << text_of("sim.jsonl");
  const std::string refused = run(program("devices set-address far 1 2 --show s/show.yaml 2>&1; test $? = 4"));
  EXPECT_NE(refused.find("CANopen"), std::string::npos) << refused;
}

TEST_F(ProgramOnVcan, DevicesListTellsWhatTheMachineHas) {
  const Json machine = json_of("devices list s/show.yaml")["machine"];
  std::map<std::string, Json> can;
  for (const Json& interface : machine["can"]) can[interface["name"].get<std::string>()] = interface;
  ASSERT_TRUE(can.contains("can0") && can.contains("can1") && can.contains("vcan0")) << machine.dump(1);
  EXPECT_EQ(can["vcan0"]["buses"], Json::array({"far"}));
  EXPECT_TRUE(can["vcan0"]["up"].get<bool>());
  EXPECT_FALSE(can["vcan0"].contains("state"));
  EXPECT_TRUE(can["can0"].contains("state"));
  int ftdi = 0;
  for (const Json& port : machine["serial"]) {
    if (!port.contains("usb")) continue;
    EXPECT_EQ(port["usb"]["vendor"], "0403") << port.dump();
    EXPECT_EQ(port["usb"]["product"], "6001") << port.dump();
    ++ftdi;
  }
  EXPECT_EQ(ftdi, 2);
}

}  // namespace
}  // namespace footlight::hardware
