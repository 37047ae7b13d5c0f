// SPDX-License-Identifier: Apache-2.0
#include "sim/rtu_bus.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "small_rig.hpp"

namespace footlight::sim {
namespace {

using drivers::ModbusReply;
using drivers::ModbusRequest;
using drivers::SendStatus;
using Outcome = ModbusReply::Outcome;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

Rig rtu_rig(int nodes, int bits_per_second) { return small_rig(BusKind::modbus_rtu, nodes, 4, bits_per_second); }

ModbusRequest read(int unit, int first, int count) {
  return {static_cast<std::uint8_t>(unit), 3, static_cast<std::uint16_t>(first), static_cast<std::uint16_t>(count), {}};
}
ModbusRequest preload(int unit, int sequence, int look) {
  const auto both = static_cast<std::uint16_t>(look * 0x0101);
  return {static_cast<std::uint8_t>(unit), 16, 0, 3, {static_cast<std::uint16_t>(0xA300 + sequence), both, both}};
}
ModbusRequest latch(int sequence) {
  const auto word = static_cast<std::uint16_t>(0xA300 + sequence);
  return {0, 16, 0x20, 3, {word, static_cast<std::uint16_t>(word ^ 0x5A5A), static_cast<std::uint16_t>(word ^ 0xA5A5)}};
}

struct Line : Bench {
  using Bench::Bench;
  drivers::ModbusPort& port = simulated.modbus(BusIndex(0));
  /// Steps until the request is over.
  std::optional<ModbusReply> exchange(const ModbusRequest& request) {
    EXPECT_EQ(port.submit(request), SendStatus::accepted);
    while (port.busy()) simulated.advance_to(simulated.next_event());
    return port.poll();
  }
};

TEST(RtuBus, CharactersHaveElevenBitsAndFramesKeepTheirSilenceToTheNanosecond) {
  Line line(rtu_rig(1, 19'200));
  line.exchange(latch(1));  // 15 characters: 165 bits at 19,200 Bd are 8,593,750 ns
  line.exchange(latch(2));
  const auto lines = line.lines();
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_THAT(lines[0], StartsWith("8593.750 b > 00100020"));
  // The silence of 38.5 bits, 2,005,208 ns, is longer than the gap after a broadcast; then 165 bits again.
  EXPECT_THAT(lines[1], StartsWith("19192.708 b > 00100020"));
  EXPECT_EQ(line.simulated.use(BusIndex(0)).busy, 2 * Duration(8'593'750 + 2'005'208));
}

TEST(RtuBus, AboveNineteenTwoTheSilenceIsFixed) {
  Line line(rtu_rig(1, 115'200));
  const auto reply = line.exchange(read(1, 0x40, 6));
  ASSERT_TRUE(reply && reply->outcome == Outcome::ok);
  const Instant replied = line.clock.now();
  line.port.submit(latch(1));
  line.simulated.advance_to(replied + microseconds(1750) + Duration(1'432'292) - Duration(1));
  EXPECT_TRUE(line.port.busy());
  EXPECT_EQ(line.lines().size(), 2U);
  line.run_for(Duration(1));  // 165 bits at 115,200 Bd are 1,432,292 ns
  EXPECT_EQ(line.lines().size(), 3U);
}

TEST(RtuBus, ALatchActsWhenTheSilenceAfterItHasBeenHeard) {
  Line line(rtu_rig(1, 115'200));
  ASSERT_EQ(line.exchange(preload(1, 7, 9))->outcome, Outcome::ok);
  line.run_for(milliseconds(10));
  line.port.submit(latch(7));
  line.run_for(Duration(1'432'292) + microseconds(1750) - Duration(1));
  EXPECT_EQ(line.simulated.shown(NodeIndex(0), 0), 255);
  line.run_for(Duration(1));
  EXPECT_EQ(line.simulated.shown(NodeIndex(0), 0), 9);
}

TEST(RtuBus, WireTimeBoundsEveryExchange) {
  Line line(rtu_rig(3, 115'200));
  Duration longest{};
  const ModbusRequest request = read(2, 0x40, 6);
  line.run_for(milliseconds(10));
  for (int i = 0; i < 300; ++i) {
    const Instant start = line.clock.now();
    ASSERT_EQ(line.exchange(request)->outcome, Outcome::ok);
    line.run_for(microseconds(1750));
    longest = std::max(longest, line.clock.now() - start);
  }
  EXPECT_LE(longest, line.port.wire_time(request));
  EXPECT_GT(longest, line.port.wire_time(request) - microseconds(100));
  // 8 and 17 characters, 5 ms of turnaround, the silence: 763,889 + 1,623,264 + 5,000,000 + 1,750,000 ns.
  EXPECT_EQ(line.port.wire_time(request), Duration(9'137'153));
}

// The silence before a reply is longer at 1,200 Bd than the time that the port waited for it.
TEST(RtuBus, RegressionAReplyOnASlowLineIsWaitedFor) {
  for (const int bits_per_second : {1200, 2400, 9600}) {
    Line line(rtu_rig(1, bits_per_second));
    for (int i = 0; i < 50; ++i) {
      const Instant start = line.clock.now();
      EXPECT_EQ(line.exchange(read(1, 0x40, 6))->outcome, Outcome::ok) << bits_per_second;
      EXPECT_LE(line.clock.now() - start, line.port.wire_time(read(1, 0x40, 6))) << bits_per_second;
    }
  }
}

TEST(RtuBus, NobodyThereIsATimeoutOfThirtyMillisecondsAfterTheRequest) {
  Line line(rtu_rig(1, 115'200));
  const auto reply = line.exchange(read(9, 0x40, 1));
  ASSERT_TRUE(reply.has_value());
  EXPECT_EQ(reply->outcome, Outcome::timeout);
  EXPECT_EQ(line.clock.now(), kStart + Duration(763'889) + milliseconds(30));
}

TEST(RtuBus, ExceptionsAndValuesAreHandedOn) {
  Line line(rtu_rig(1, 115'200));
  const auto refused = line.exchange(read(1, 0x99, 1));
  EXPECT_EQ(refused->outcome, Outcome::exception);
  EXPECT_EQ(refused->exception_code, 2);
  const auto boots = line.exchange(read(1, 0x42, 2));
  EXPECT_THAT(boots->values, ElementsAre(0, 1));
  EXPECT_EQ(line.port.poll(), std::nullopt) << "a reply is given once";
}

TEST(RtuBus, OneRequestAtATime) {
  Line line(rtu_rig(1, 115'200));
  EXPECT_EQ(line.port.submit(read(1, 0x40, 1)), SendStatus::accepted);
  EXPECT_EQ(line.port.submit(read(1, 0x40, 1)), SendStatus::busy);
}

TEST(RtuBus, AReplyAfterTheTimeoutIsTakenForThatToTheNextRequest) {
  // Boots are read, then the uptime, of a node that is up to 120 ms late: RTU cannot tell the replies apart.
  Line line(rtu_rig(1, 115'200), *Faults::parse("delay=120ms"), 4);
  line.run_for(std::chrono::seconds(30));
  int taken_for_another = 0;
  for (int i = 0; i < 100; ++i) {
    const auto boots = line.exchange(read(1, 0x43, 1));
    if (boots->outcome != Outcome::timeout) continue;
    const auto uptime = line.exchange(read(1, 0x44, 1));
    if (uptime->outcome == Outcome::ok && uptime->values.at(0) == 1) {
      ++taken_for_another;
      // From now on each reply is that to the request before, without any error ...
      const auto next = line.exchange(read(1, 0x43, 1));
      if (next->outcome == Outcome::ok) {
        EXPECT_GE(next->values.at(0), 30);
      }
    }
    line.run_for(milliseconds(200));
    line.exchange(latch(200));  // ... until a broadcast empties the buffer
  }
  EXPECT_GT(taken_for_another, 10);
}

TEST(RtuBus, ALateReplyOfAnotherUnitIsPassedOver) {
  Line line(rtu_rig(2, 115'200), *Faults::parse("delay=120ms"), 4);
  line.run_for(std::chrono::seconds(30));
  for (int i = 0; i < 100; ++i) {
    const auto boots = line.exchange(read(1, 0x43, 1));
    if (boots->outcome != Outcome::timeout) continue;
    line.run_for(milliseconds(200));  // it has come meanwhile
    const auto uptime = line.exchange(read(2, 0x44, 1));
    if (uptime->outcome == Outcome::ok) {
      EXPECT_GE(uptime->values.at(0), 30);
    }
    line.run_for(milliseconds(200));
    line.exchange(latch(200));
  }
}

TEST(RtuBus, CorruptionEndsInATimeoutOrAGarbledReplyAndNeverInAWrongValue) {
  Line line(rtu_rig(1, 115'200), *Faults::parse("corrupt=20%"), 4);
  int timeouts = 0;
  int garbled = 0;
  for (int i = 0; i < 500; ++i) {
    const auto reply = line.exchange(read(1, 0x42, 2));
    timeouts += reply->outcome == Outcome::timeout ? 1 : 0;
    garbled += reply->outcome == Outcome::garbled ? 1 : 0;
    if (reply->outcome == Outcome::ok) {
      EXPECT_THAT(reply->values, ElementsAre(0, 1));
    }
  }
  EXPECT_NEAR(timeouts, 100, 45);  // of requests; a reply to another address is passed over and ends so, too
  EXPECT_NEAR(garbled, 80, 40);
}

TEST(RtuBus, FramesHeardTwiceAreHarmless) {
  Line line(rtu_rig(2, 115'200), *Faults::parse("duplicate=50%"), 4);
  for (int i = 1; i <= 200; ++i) {
    ASSERT_EQ(line.exchange(preload(1, i, i))->outcome, Outcome::ok);
    ASSERT_EQ(line.exchange(preload(2, i, 255 - i))->outcome, Outcome::ok);
    line.exchange(latch(i));
    line.exchange({0, 16, 0x30, 2, {0, 0}});  // heartbeat
    ASSERT_EQ(line.simulated.shown(NodeIndex(0), 3), i);
    ASSERT_EQ(line.simulated.shown(NodeIndex(1), 3), 255 - i);
  }
  EXPECT_THAT(line.trace.str(), HasSubstr("heard twice"));
}

}  // namespace
}  // namespace footlight::sim
