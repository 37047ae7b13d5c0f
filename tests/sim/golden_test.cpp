// SPDX-License-Identifier: Apache-2.0
// The markers hear the golden frames of tests/data/wire, which no code of ours has made.
#include <fstream>
#include <map>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sim/markers/canopen_marker.hpp"
#include "sim/markers/modbus_marker.hpp"
#include "sim/markers/serial_marker.hpp"

namespace footlight::sim {
namespace {

using Octets = std::vector<std::uint8_t>;

std::multimap<std::string, std::string> golden(const std::string& name) {
  std::ifstream file(std::string(FOOTLIGHT_TEST_DATA) + "/wire/" + name);
  EXPECT_TRUE(file.is_open()) << name;
  std::multimap<std::string, std::string> lines;
  for (std::string line; std::getline(file, line);) {
    const auto colon = line.find(": ");
    if (!line.empty() && line[0] != '#' && colon != std::string::npos) {
      lines.emplace(line.substr(0, colon), line.substr(colon + 2));
    }
  }
  return lines;
}

Octets octets(const std::string& text) {
  std::istringstream in(text);
  Octets bytes;
  for (std::string byte; in >> byte;) bytes.push_back(static_cast<std::uint8_t>(std::stoi(byte, nullptr, 16)));
  return bytes;
}

drivers::CanFrame can_frame(const std::string& text) {
  drivers::CanFrame frame;
  frame.id = static_cast<std::uint16_t>(std::stoi(text.substr(0, 3), nullptr, 16));
  for (std::size_t i = 4; i + 1 < text.size(); i += 2) {
    frame.data[frame.length++] = static_cast<std::uint8_t>(std::stoi(text.substr(i, 2), nullptr, 16));
  }
  return frame;
}

/// Node 7 of 32 channels and node 9 of five; node 7 has been switched on 0x0102 times.
struct Golden : ::testing::Test {
  Golden() {
    for (int i = 0; i < 0x0102; ++i) seven.power_on(kStart);
    nine.power_on(kStart);
  }
  void expect_looks_of_seven() const {
    for (int i = 0; i < 32; ++i) EXPECT_EQ(seven.shown(i), 7 * i % 256) << "channel " << i;
  }
  void expect_looks_of_nine() const {
    const std::vector<int> looks{1, 0, 0, 255, 9};
    for (int i = 0; i < 5; ++i) EXPECT_EQ(nine.shown(i), looks[static_cast<std::size_t>(i)]) << "channel " << i;
  }
  void expect_look_five() const { EXPECT_EQ(seven.look(5), (Look{{0x7C, 0xFC, 0x00}, Effect::blink, 200})); }
  NodeModel seven{32, true};
  NodeModel nine{5, true};
};

TEST_F(Golden, SerialFramesAreUnderstoodAndAnswered) {
  const auto lines = golden("serial.txt");
  const auto bytes = [&](const char* name) { return octets(lines.find(name)->second); };
  SerialMarker marker(7, seven);
  SerialMarker other(9, nine);
  EXPECT_EQ(marker.receive(bytes("preload-32"), kStart), bytes("receipt-32"));
  EXPECT_EQ(other.receive(bytes("preload-5"), kStart), bytes("receipt-5"));
  marker.receive(bytes("latch"), kStart);
  other.receive(bytes("latch"), kStart);
  expect_looks_of_seven();
  EXPECT_EQ(nine.shown(0), 255) << "latch 17 is not 240";
  marker.receive(bytes("look"), kStart);
  expect_look_five();
  marker.receive(Octets{1, 0, 1, 0, 1, 0}, kStart);  // three that are dropped
  EXPECT_EQ(marker.receive(bytes("ask"), kStart), bytes("status"));
  marker.receive(bytes("identify"), kStart);
  EXPECT_TRUE(seven.identifying(kStart));
  EXPECT_TRUE(marker.receive(bytes("keep-plan"), kStart).empty()) << "to all: nobody answers";
  EXPECT_EQ(marker.receive(bytes("keep-patch"), kStart), bytes("kept"));
  seven.power_on(kStart);
  EXPECT_EQ(marker.receive(bytes("ask-kept"), kStart), bytes("kept")) << "it outlasts power-off";
  marker.receive(bytes("preload-32"), kStart);
  marker.receive(bytes("latch"), kStart);
  const Instant late = kStart + milliseconds(1100);
  marker.receive(bytes("heartbeat"), late);
  EXPECT_EQ(seven.state(), NodeState::showing);
}

TEST_F(Golden, CanFramesAreUnderstoodAndAnswered) {
  const auto lines = golden("canopen.txt");
  CanopenMarker marker(7, seven);
  CanopenMarker other(9, nine);
  marker.power_on();
  other.power_on();
  const auto one = [&](const char* name) { return can_frame(lines.find(name)->second); };
  const auto hear = [&](const char* name) {
    const auto [begin, end] = lines.equal_range(name);
    for (auto line = begin; line != end; ++line) {
      marker.receive(can_frame(line->second), kStart);
      other.receive(can_frame(line->second), kStart);
    }
  };
  for (const char* name : {"start", "preload-32", "preload-5", "latch", "look"}) hear(name);
  expect_looks_of_seven();
  expect_looks_of_nine();
  expect_look_five();
  for (int i = 0; i < 3; ++i) marker.count_error();
  EXPECT_EQ(marker.status(), one("status"));
  EXPECT_EQ(marker.boot_up(), one("boot-up"));
  EXPECT_EQ(marker.heartbeat(), one("operational"));
  marker.receive(can_frame("207#01"), kStart);  // too short
  EXPECT_EQ(marker.emergency(), one("emergency"));
  marker.receive(one("heartbeat"), kStart + milliseconds(1100));
  EXPECT_EQ(seven.state(), NodeState::showing);
}

TEST_F(Golden, ANodeThatFollowsANewerEpochRefusesWhoeverComesWithAnOlderOne) {
  const auto lines = golden("canopen.txt");
  const auto one = [&](const char* name) { return can_frame(lines.find(name)->second); };
  const auto hear = [&](CanopenMarker& marker, const char* name, Instant now) {
    const auto [begin, end] = lines.equal_range(name);
    for (auto line = begin; line != end; ++line) marker.receive(can_frame(line->second), now);
  };
  CanopenMarker marker(7, seven);
  marker.power_on();
  hear(marker, "start", kStart);
  drivers::CanFrame newer = one("lead");
  newer.data[4] = 0x04;
  EXPECT_EQ(marker.receive(newer, kStart), CanopenMarker::Reaction::none);
  EXPECT_EQ(marker.receive(one("lead"), kStart), CanopenMarker::Reaction::emergency);
  EXPECT_EQ(marker.emergency(), one("fenced"));
  for (const char* name : {"preload-32", "look", "plan-check", "latch"}) hear(marker, name, kStart);
  EXPECT_EQ(seven.shown(1), 255) << "nothing of it is shown";
  EXPECT_NE(seven.look(5), (Look{{0x7C, 0xFC, 0x00}, Effect::blink, 200}));
  EXPECT_EQ(seven.plan_check(), 0U);
  EXPECT_EQ(marker.receive(newer, kStart), CanopenMarker::Reaction::none);
  for (const char* name : {"preload-32", "latch"}) hear(marker, name, kStart);
  expect_looks_of_seven();
  const Instant later = kStart + milliseconds(2600);
  EXPECT_EQ(marker.receive(one("lead"), later), CanopenMarker::Reaction::none) << "the newer one has gone";
  hear(marker, "look", later);
  expect_look_five();
}

TEST_F(Golden, SdoRequestsAreAnswered) {
  const auto lines = golden("canopen.txt");
  CanopenMarker marker(7, seven);
  marker.power_on();
  const auto frames = [&](const std::string& name) {
    std::vector<drivers::CanFrame> out;
    const auto [begin, end] = lines.equal_range(name);
    for (auto line = begin; line != end; ++line) out.push_back(can_frame(line->second));
    return out;
  };
  marker.receive(frames("plan-check").front(), kStart);
  for (const std::string name : {"sdo-product", "sdo-name", "sdo-identify", "sdo-patch", "sdo-nothing"}) {
    std::vector<drivers::CanFrame> answers;
    for (const drivers::CanFrame& request : frames(name)) {
      EXPECT_EQ(marker.receive(request, kStart), CanopenMarker::Reaction::sdo) << name;
      answers.push_back(marker.sdo_answer());
    }
    EXPECT_EQ(answers, frames(name + "-answer")) << name;
  }
  EXPECT_TRUE(seven.identifying(kStart));
}

TEST_F(Golden, ModbusFramesAreUnderstood) {
  const auto lines = golden("modbus.txt");
  const auto bytes = [&](const char* name) { return octets(lines.find(name)->second); };
  ModbusMarker marker(7, footlight_profile(), seven);
  ModbusMarker other(9, footlight_profile(), nine);
  EXPECT_EQ(marker.receive_rtu(bytes("preload-32"), kStart).size(), 8U);
  EXPECT_EQ(other.receive_rtu(bytes("preload-5"), kStart).size(), 8U);
  EXPECT_EQ(nine.pending_sequence(), 240);
  for (const char* name : {"latch", "look"}) EXPECT_TRUE(marker.receive_rtu(bytes(name), kStart).empty());
  expect_looks_of_seven();
  expect_look_five();
  const Octets status = marker.receive_rtu(bytes("ask"), kStart);
  ASSERT_EQ(status.size(), 17U);
  // 17 shown and none pending, the CRC that serial.txt and canopen.txt have for these looks, state 1, boots 0x0102.
  EXPECT_EQ(Octets(status.begin() + 3, status.begin() + 11), (Octets{17, 0, 0x99, 0x5B, 0, 1, 1, 2}));
  EXPECT_TRUE(marker.receive_rtu(bytes("plan-check"), kStart).empty());
  EXPECT_EQ(marker.receive_rtu(bytes("patch-check"), kStart).size(), 8U);
  const Octets kept = marker.receive_rtu(bytes("ask-kept"), kStart);
  ASSERT_EQ(kept.size(), 21U);
  EXPECT_EQ(Octets(kept.begin() + 3, kept.begin() + 13),
            (Octets{0x89, 0xAB, 0xCD, 0xEF, 0x12, 0x34, 0x56, 0x78, 0, 0}));
  marker.receive_rtu(bytes("heartbeat"), kStart + milliseconds(1100));
  EXPECT_EQ(seven.state(), NodeState::showing);
}

}  // namespace
}  // namespace footlight::sim
