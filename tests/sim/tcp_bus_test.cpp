// SPDX-License-Identifier: Apache-2.0
#include "sim/tcp_bus.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/modbus_frames.hpp"
#include "small_rig.hpp"

namespace footlight::sim {
namespace {

using drivers::ModbusReply;
using drivers::ModbusRequest;
using drivers::SendStatus;
using Outcome = ModbusReply::Outcome;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

Rig tcp_rig(int nodes) { return small_rig(BusKind::modbus_tcp, nodes, 4, 115'200); }

ModbusRequest read(int unit, int first, int count) {
  return {static_cast<std::uint8_t>(unit), 3, static_cast<std::uint16_t>(first), static_cast<std::uint16_t>(count), {}};
}
ModbusRequest preload(int unit, int sequence, int look) {
  const auto both = static_cast<std::uint16_t>(look * 0x0101);
  return {static_cast<std::uint8_t>(unit), 16, 0, 3, {static_cast<std::uint16_t>(0xA300 + sequence), both, both}};
}
ModbusRequest latch(int unit, int sequence) {
  const auto word = static_cast<std::uint16_t>(0xA300 + sequence);
  return {static_cast<std::uint8_t>(unit),
          16,
          0x20,
          3,
          {word, static_cast<std::uint16_t>(word ^ 0x5A5A), static_cast<std::uint16_t>(word ^ 0xA5A5)}};
}

struct Net : Bench {
  using Bench::Bench;
  drivers::ModbusPort& port = simulated.modbus(BusIndex(0));
  std::optional<ModbusReply> exchange(const ModbusRequest& request) {
    EXPECT_EQ(port.submit(request), SendStatus::accepted);
    while (port.busy()) simulated.advance_to(simulated.next_event());
    return port.poll();
  }
};

TEST(TcpBus, ExchangesTakeTheTurnaroundAndSomeHundredMicroseconds) {
  Net net(tcp_rig(3));
  const ModbusRequest request = read(2, 0x42, 2);
  Duration shortest = milliseconds(100);
  Duration longest{};
  for (int i = 0; i < 300; ++i) {
    const Instant start = net.clock.now();
    const auto reply = net.exchange(request);
    ASSERT_EQ(reply->outcome, Outcome::ok);
    ASSERT_THAT(reply->values, ElementsAre(0, 1));
    shortest = std::min(shortest, net.clock.now() - start);
    longest = std::max(longest, net.clock.now() - start);
  }
  EXPECT_GT(shortest, microseconds(500 + 2 * 80));
  EXPECT_LT(shortest, microseconds(500 + 2 * 250 + 100));
  EXPECT_LE(longest, net.port.wire_time(request));
  EXPECT_GT(longest, milliseconds(4));
}

TEST(TcpBus, AGatewayKnowsANodeByTheAddressThatItHasTaken) {
  constexpr int kUniqueId = 0x60;
  constexpr std::uint16_t kReaddress = 0x6C;
  Net net(tcp_rig(3));
  ModbusLine& line = net.simulated.modbus_line(BusIndex(0));
  const auto id = net.exchange(read(2, kUniqueId, 2))->values;
  ASSERT_EQ(id.size(), 2U);
  const auto ask = [&](const ModbusRequest& request) {
    line.say(1, tcp_frame(7, request.unit, request_pdu(request)));
    net.simulated.advance_to(net.clock.now() + milliseconds(50));
    int client = 0;
    std::vector<std::uint8_t> frame;
    return line.hear(client, frame);
  };
  EXPECT_TRUE(ask({2, 16, kReaddress, 4, {id[0], id[1], 9, 0x5A00 | (0x5A ^ 9)}}));
  EXPECT_FALSE(ask(read(2, 0x40, 1)));
  EXPECT_TRUE(ask(read(9, 0x40, 1)));
}

TEST(TcpBus, ABroadcastGoesToEachNodeInTurn) {
  Net net(tcp_rig(3));
  for (int unit = 1; unit <= 3; ++unit) ASSERT_EQ(net.exchange(preload(unit, 5, 10 + unit))->outcome, Outcome::ok);
  EXPECT_EQ(net.exchange(latch(0, 5)), std::nullopt);
  net.run_for(milliseconds(1));
  for (std::uint32_t node = 0; node < 3; ++node) {
    EXPECT_EQ(net.simulated.shown(NodeIndex(node), 0), static_cast<int>(11 + node));
  }
  const auto reply = net.exchange(read(1, 0x40, 1));
  EXPECT_THAT(reply->values, ElementsAre(0x0500)) << "the answers to the broadcast are not taken for it";
}

TEST(TcpBus, WhatIsLostIsSentAgainAndComesInOrder) {
  Net net(tcp_rig(1), *Faults::parse("loss=20%"), 7);
  int timeouts = 0;
  int ok = 0;
  for (int i = 1; i <= 300; ++i) {
    const auto reply = net.exchange(preload(1, 1 + i % 240, i % 255));
    timeouts += reply->outcome == Outcome::timeout ? 1 : 0;
    ok += reply->outcome == Outcome::ok ? 1 : 0;
  }
  EXPECT_EQ(timeouts + ok, 300) << "a late reply has another transaction and is never taken for the right one";
  EXPECT_GT(timeouts, 60);
  EXPECT_GT(ok, 20);
  EXPECT_THAT(net.trace.str(), HasSubstr("sent again by TCP"));
  net.run_for(std::chrono::seconds(1));
  net.exchange(latch(0, 1 + 300 % 240));
  net.run_for(std::chrono::seconds(1));
  EXPECT_EQ(net.simulated.shown(NodeIndex(0), 0), 300 % 255) << "the last preload arrived last";
}

TEST(TcpBus, NobodyThereIsATimeout) {
  Net net(tcp_rig(2), *Faults::parse("dead=2"));
  EXPECT_EQ(net.exchange(read(1, 0x40, 1))->outcome, Outcome::timeout);
  EXPECT_EQ(net.exchange(read(9, 0x40, 1))->outcome, Outcome::timeout);
  EXPECT_EQ(net.clock.now(), kStart + milliseconds(60)) << "30 ms each";
}

}  // namespace
}  // namespace footlight::sim
