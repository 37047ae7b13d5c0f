// SPDX-License-Identifier: Apache-2.0
#include "sim/serial_bus.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "serial_frame.hpp"
#include "small_rig.hpp"

namespace footlight::sim {
namespace {

using drivers::SendStatus;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr int kBaud = 115'200;

Rig serial_rig(int nodes) { return small_rig(BusKind::serial, nodes, 2, kBaud); }
Octets heartbeat() { return serial_frame({1, 3, 0, 9, 1, 1, 1, 1, 1}); }
Octets preload(int address, int sequence, int look) {
  const auto byte = [](int value) { return static_cast<std::uint8_t>(value); };
  return serial_frame({1, 1, byte(address), 9, byte(sequence), 0, byte(look), byte(look)});
}
Octets latch(int sequence) {
  const auto s = static_cast<std::uint8_t>(sequence);
  const auto guard = static_cast<std::uint8_t>(0x5A ^ s);
  return serial_frame({1, 2, 0, 9, s, guard, guard, guard, guard});
}
Octets ask(int address) { return serial_frame({1, 4, static_cast<std::uint8_t>(address), 9, 0}); }

Octets read_all(Bench& bench) {
  Octets bytes(4096);
  bytes.resize(bench.simulated.serial(BusIndex(0)).read(bytes));
  return bytes;
}

std::int64_t nanoseconds_of(const std::string& line) { return std::llround(std::stod(line) * 1000); }

TEST(SerialBus, CharactersTakeTenBitsToTheNanosecond) {
  Bench bench(serial_rig(1));
  auto& port = bench.simulated.serial(BusIndex(0));
  EXPECT_EQ(port.wire_time(1), Duration(86'806));
  const Octets bytes = latch(1);
  ASSERT_EQ(bytes.size(), 16U);
  port.write(bytes);
  bench.run_for(milliseconds(5));
  EXPECT_THAT(bench.lines()[0], testing::StartsWith("1388.889 b > "));  // 160 bits at 115,200 Bd
  EXPECT_EQ(bench.simulated.use(BusIndex(0)).busy, Duration(1'388'889));
}

TEST(SerialBus, FramesOfOneWriteActEachAtItsOwnEnd) {
  Bench bench(serial_rig(1));
  auto& port = bench.simulated.serial(BusIndex(0));
  Octets both = preload(0, 1, 5);  // to all: an answer would meet the second frame
  const std::size_t first = both.size();
  const Octets second = serial_frame({1, 2, 1, 9, 1, 0x5B, 0x5B, 0x5B, 0x5B});
  both.insert(both.end(), second.begin(), second.end());
  port.write(both);
  bench.run_until(port.wire_time(first));
  EXPECT_EQ(bench.simulated.shown(NodeIndex(0), 0), 255);
  bench.run_until(port.wire_time(first) + port.wire_time(second.size()) - Duration(1));
  EXPECT_EQ(bench.simulated.shown(NodeIndex(0), 0), 255);
  bench.run_for(Duration(1));
  EXPECT_EQ(bench.simulated.shown(NodeIndex(0), 0), 5);
}

TEST(SerialBus, AnswersBeginTwoHundredMicrosecondsToTwoMillisecondsAfterTheRequest) {
  Bench bench(serial_rig(1));
  auto& port = bench.simulated.serial(BusIndex(0));
  Duration shortest = milliseconds(100);
  Duration longest{};
  for (int i = 0; i < 300; ++i) {
    const Instant asked = bench.clock.now();
    const Octets request = ask(1);
    port.write(request);
    bench.run_for(milliseconds(6));
    const Octets answer = read_all(bench);
    ASSERT_TRUE(serial_payload(answer).has_value());
    const Instant ended(Duration(nanoseconds_of(bench.lines().back())));
    const Duration turnaround = ended - asked - port.wire_time(request.size()) - port.wire_time(answer.size());
    shortest = std::min(shortest, turnaround);
    longest = std::max(longest, turnaround);
  }
  EXPECT_GE(shortest, microseconds(200));
  EXPECT_LT(shortest, microseconds(230));
  EXPECT_LE(longest, microseconds(2000));
  EXPECT_GT(longest, microseconds(1970));
}

TEST(SerialBus, WhoTalksAtTheSameTimeIsGarbled) {
  Bench bench(serial_rig(2));
  auto& port = bench.simulated.serial(BusIndex(0));
  port.write(ask(1));
  bench.run_for(port.wire_time(ask(1).size()) + milliseconds(1));
  port.write(Octets(40, 0xAA));  // 3.5 ms of talking where the answer comes
  bench.run_for(milliseconds(10));
  EXPECT_FALSE(serial_payload(read_all(bench)).has_value());
  EXPECT_THAT(bench.trace.str(), HasSubstr("garbled"));
  port.write(Octets{0});
  port.write(ask(1));
  bench.run_for(milliseconds(10));
  EXPECT_TRUE(serial_payload(read_all(bench)).has_value()) << "the next exchange is in step again";
}

TEST(SerialBus, ThePortIsBusyWhenItsBufferIsFull) {
  Bench bench(serial_rig(1));
  auto& port = bench.simulated.serial(BusIndex(0));
  EXPECT_EQ(port.write(Octets(4000, 0x11)), SendStatus::accepted);
  EXPECT_EQ(port.write(Octets(97, 0x11)), SendStatus::busy);
  EXPECT_EQ(port.write(Octets(96, 0x11)), SendStatus::accepted);
  bench.run_for(milliseconds(10));
  EXPECT_EQ(port.write(Octets(97, 0x11)), SendStatus::accepted);
}

TEST(SerialBus, LossAndCorruptionComeInTheSharesAskedFor) {
  Bench bench(serial_rig(1), *Faults::parse("loss=5%,corrupt=10%"), 3);
  auto& port = bench.simulated.serial(BusIndex(0));
  constexpr int kFrames = 4000;
  for (int i = 0; i < kFrames; ++i) {
    port.write(heartbeat());
    bench.run_for(milliseconds(2));
  }
  int lost = 0;
  int corrupt = 0;
  for (const auto& line : bench.lines()) {
    lost += line.find("lost by n1") != std::string::npos ? 1 : 0;
    corrupt += line.find("corrupt") != std::string::npos ? 1 : 0;
  }
  EXPECT_NEAR(lost, 200, 69);  // five standard deviations
  EXPECT_NEAR(corrupt, 400, 95);
}

TEST(SerialBus, FramesHeardTwiceAreHarmlessAndAnsweredOnce) {
  Bench bench(serial_rig(1), *Faults::parse("duplicate=50%"), 3);
  auto& port = bench.simulated.serial(BusIndex(0));
  int answers = 0;
  for (int i = 1; i <= 200; ++i) {
    port.write(preload(1, i, i));
    bench.run_for(milliseconds(10));
    port.write(heartbeat());
    port.write(latch(i));
    bench.run_for(milliseconds(4));
    ASSERT_EQ(bench.simulated.shown(NodeIndex(0), 1), i);
  }
  for (const auto& line : bench.lines()) answers += line.find(" < ") != std::string::npos ? 1 : 0;
  EXPECT_EQ(answers, 200);
}

TEST(SerialBus, ADelayedAnswerIsLateByNoMoreThanAskedFor) {
  Bench bench(serial_rig(1), *Faults::parse("delay=20ms"), 3);
  auto& port = bench.simulated.serial(BusIndex(0));
  Duration longest{};
  for (int i = 0; i < 200; ++i) {
    const Instant asked = bench.clock.now();
    port.write(ask(1));
    bench.run_for(milliseconds(30));
    const Instant ended(Duration(nanoseconds_of(bench.lines().back())));
    longest = std::max(longest, ended - asked - port.wire_time(ask(1).size()) - port.wire_time(20));
  }
  EXPECT_LE(longest, milliseconds(22));
  EXPECT_GT(longest, milliseconds(19));
}

TEST(SerialBus, TheLeaseRunsOutByItselfAtItsInstant) {
  Bench bench(serial_rig(1));
  auto& port = bench.simulated.serial(BusIndex(0));
  port.write(preload(1, 1, 5));
  bench.run_for(milliseconds(10));
  port.write(latch(1));
  const Instant latched = bench.clock.now() + port.wire_time(16);
  bench.simulated.advance_to(latched);
  bench.simulated.advance_to(latched + milliseconds(2500) - Duration(1));
  EXPECT_EQ(bench.simulated.shown(NodeIndex(0), 0), 5);
  EXPECT_EQ(bench.simulated.next_event(), latched + milliseconds(2500));
  bench.run_for(Duration(1));
  EXPECT_EQ(bench.simulated.shown(NodeIndex(0), 0), 255);
  const auto all = bench.lines();
  ASSERT_GE(all.size(), 3U);
  EXPECT_THAT(all[all.size() - 2], HasSubstr("b * - n1 holds"));
  EXPECT_THAT(all.back(), HasSubstr("b * - n1 lost guidance"));
  EXPECT_EQ(bench.simulated.next_event(), kNever);
}

}  // namespace
}  // namespace footlight::sim
