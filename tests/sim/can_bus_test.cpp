// SPDX-License-Identifier: Apache-2.0
#include "sim/can_bus.hpp"

#include <algorithm>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "can_frame.hpp"
#include "sim/can_bits.hpp"
#include "small_rig.hpp"

namespace footlight::sim {
namespace {

using drivers::CanFrame;
using drivers::SendStatus;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

Rig can_rig(int nodes, int channels = 8) { return small_rig(BusKind::can, nodes, channels, 500'000); }

/// Lines without the nodes' own heartbeats, which come when they like.
std::vector<std::string> lines(const Bench& bench) {
  std::vector<std::string> kept;
  for (const auto& line : bench.lines()) {
    if (line.find("#7F") == std::string::npos && line.find("#05") == std::string::npos) kept.push_back(line);
  }
  return kept;
}

/// What was on the bus, without times and directions.
std::vector<std::string> frames(const Bench& bench) {
  std::vector<std::string> kept;
  for (const auto& line : lines(bench)) {
    const auto hash = line.find('#');
    if (hash != std::string::npos) kept.push_back(line.substr(hash - 3));
  }
  return kept;
}

TEST(CanBus, FramesEndToTheBitAndThreeBitsLieBetweenThem) {
  Bench bench(can_rig(1));
  auto& port = bench.simulated.can(BusIndex(0));
  port.send(frame(0x000, {}));
  port.send(frame(0x000, {}));
  bench.run_for(milliseconds(1));
  // 50 bits of 2 us each (can_bits_test), then three, then 50 again.
  EXPECT_THAT(lines(bench), ElementsAre("100.000 b > 000#", "206.000 b > 000#"));
  EXPECT_EQ(bench.simulated.use(BusIndex(0)).busy, microseconds(2 * 106));
  EXPECT_EQ(bench.simulated.use(BusIndex(0)).frames, 2U);
}

TEST(CanBus, WireTimeIsThatOfTheWorstFrame) {
  Bench bench(can_rig(1));
  auto& port = bench.simulated.can(BusIndex(0));
  EXPECT_EQ(port.wire_time(frame(0x201, {1, 2, 3, 4, 5, 6, 7, 8})), microseconds(270));
  EXPECT_EQ(port.wire_time(frame(0x080, {1})), microseconds(2 * 65));
}

TEST(CanBus, TheLowestIdentifierWinsWhenTheBusGetsIdle) {
  Bench bench(can_rig(4));
  auto& port = bench.simulated.can(BusIndex(0));
  port.send(frame(0x000, {0x82, 0}));  // every node sends its boot-up message
  port.send(frame(0x080, {1}));
  port.send(frame(0x77E, {1}));
  bench.run_for(milliseconds(3));
  EXPECT_THAT(frames(bench), ElementsAre("000#8200", "080#01", "701#00", "702#00", "703#00", "704#00", "77E#01"));
}

TEST(CanBus, TheQueueOfTheControllerIsFirstInFirstOut) {
  Bench bench(can_rig(2));
  auto& port = bench.simulated.can(BusIndex(0));
  port.send(frame(0x000, {0x82, 0}));
  port.send(frame(0x77E, {1}));
  port.send(frame(0x080, {1}));
  bench.run_for(milliseconds(3));
  EXPECT_THAT(frames(bench), ElementsAre("000#8200", "701#00", "702#00", "77E#01", "080#01"))
      << "a SYNC behind a frame of low priority waits, as behind a Linux interface";
}

TEST(CanBus, TheQueueHoldsTenAndThenIsBusy) {
  Bench bench(can_rig(1));
  auto& port = bench.simulated.can(BusIndex(0));
  for (int i = 0; i < 10; ++i) ASSERT_EQ(port.send(frame(0x201, {i})), SendStatus::accepted);
  EXPECT_EQ(port.queued(), 10U);
  EXPECT_EQ(port.send(frame(0x201, {10})), SendStatus::busy);
  bench.simulated.advance_to(bench.simulated.next_event());
  EXPECT_EQ(port.queued(), 9U) << "one is on the wire";
  EXPECT_EQ(port.send(frame(0x201, {10})), SendStatus::accepted);
  bench.run_for(milliseconds(5));
  EXPECT_EQ(port.queued(), 0U);
}

TEST(CanBus, StatusFollowsASyncWithinFiveMillisecondsAndArbitration) {
  Bench bench(can_rig(20));
  auto& port = bench.simulated.can(BusIndex(0));
  port.send(frame(0x000, {1, 0}));
  port.send(frame(0x080, {9}));
  bench.run_for(milliseconds(1));
  bench.run_for(milliseconds(5) + microseconds(270));
  int answers = 0;
  for (CanFrame received; port.receive(received);) answers += received.id >= 0x181 && received.id <= 0x194 ? 1 : 0;
  EXPECT_EQ(answers, 20);
}

TEST(CanBus, NodesSendAHeartbeatEachSecond) {
  Bench bench(can_rig(3));
  bench.run_until(std::chrono::seconds(10));
  std::map<int, int> beats;
  auto& port = bench.simulated.can(BusIndex(0));
  for (CanFrame received; port.receive(received);) ++beats[received.id];
  EXPECT_EQ(beats, (std::map<int, int>{{0x701, 10}, {0x702, 10}, {0x703, 10}}));
}

TEST(CanBus, DisturbedFramesAreSentAgainUntilTheyArriveOnceAndInOrder) {
  Bench bench(can_rig(1), *Faults::parse("corrupt=30%"));
  auto& port = bench.simulated.can(BusIndex(0));
  port.send(frame(0x000, {1, 0}));
  std::vector<int> answered;
  constexpr int kSyncs = 2000;
  for (int i = 0; i < kSyncs; ++i) {
    ASSERT_EQ(port.send(frame(0x080, {1 + i % 240})), SendStatus::accepted);
    bench.run_for(milliseconds(8));
    for (CanFrame received; port.receive(received);) {
      if (received.id == 0x181) answered.push_back(received.data[0]);
    }
  }
  ASSERT_EQ(answered.size(), static_cast<std::size_t>(kSyncs));
  for (int i = 0; i < kSyncs; ++i) ASSERT_EQ(answered[static_cast<std::size_t>(i)], 1 + i % 240);
  const auto all = bench.lines();
  const auto corrupt = std::count_if(all.begin(), all.end(),
                                     [](const auto& line) { return line.find(" corrupt") != std::string::npos; });
  const auto sent = static_cast<double>(bench.simulated.use(BusIndex(0)).frames);
  EXPECT_NEAR(static_cast<double>(corrupt) / sent, 0.3, 0.03);
}

TEST(CanBus, AnErrorFrameTakesFourteenToTwentyBitsAndTheSpace) {
  Bench bench(can_rig(1), *Faults::parse("corrupt=30%"), 5);
  auto& port = bench.simulated.can(BusIndex(0));
  Duration before{};
  int seen = 0;
  for (int i = 0; i < 200; ++i) {
    const std::size_t lines_before = lines(bench).size();
    const Instant start = bench.clock.now();
    before = bench.simulated.use(BusIndex(0)).busy;
    port.send(frame(0x000, {}));
    bench.run_for(milliseconds(4));
    const auto all = lines(bench);
    if (all.size() - lines_before != 2) continue;  // neither once disturbed nor free of heartbeats in between
    if (all[lines_before].find("corrupt") == std::string::npos) continue;
    ++seen;
    const double first_us = std::stod(all[lines_before]) - to_seconds(start) * 1e6;
    const double second_us = std::stod(all[lines_before + 1]) - to_seconds(start) * 1e6;
    EXPECT_GE(first_us, 2 * (1 + 14) - 0.01);
    EXPECT_LE(first_us, 2 * (50 + 20) + 0.01);
    EXPECT_NEAR(second_us, first_us + 2 * (3 + 50), 0.002);
    EXPECT_GE(bench.simulated.use(BusIndex(0)).busy - before, microseconds(2 * (18 + 53)));
  }
  EXPECT_GT(seen, 20);
}

TEST(CanBus, ALostFrameIsMissedByOneReceiverAndHeardByTheOthers) {
  Bench bench(can_rig(30), *Faults::parse("loss=20%"));
  auto& port = bench.simulated.can(BusIndex(0));
  for (int i = 0; i < 5; ++i) port.send(frame(0x000, {1, 0}));
  for (int i = 1; i <= 30; ++i) {
    port.send(frame(0x200 + i, {7, 7, 7, 7, 7, 7, 7, 7}));
    bench.run_for(milliseconds(1));
  }
  port.send(frame(0x080, {1}));
  bench.run_for(milliseconds(20));
  int lit = 0;
  for (std::uint32_t node = 0; node < 30; ++node) lit += bench.simulated.shown(NodeIndex(node), 0) == 7 ? 1 : 0;
  EXPECT_GT(lit, 10);
  EXPECT_LT(lit, 29);
}

TEST(CanBus, RepeatedFramesAreHarmless) {
  Bench bench(can_rig(2), *Faults::parse("duplicate=50%"));
  auto& port = bench.simulated.can(BusIndex(0));
  port.send(frame(0x000, {1, 0}));
  for (int i = 1; i <= 100; ++i) {
    port.send(frame(0x201, {i, i, i, i, i, i, i, i}));
    port.send(frame(0x080, {i}));
    bench.run_for(milliseconds(12));
    ASSERT_EQ(bench.simulated.shown(NodeIndex(0), 3), i);
    ASSERT_EQ(bench.simulated.shown(NodeIndex(1), 3), 255);
  }
  EXPECT_THAT(bench.trace.str(), HasSubstr("repeated"));
}

TEST(CanBus, NobodyAcknowledgesWhenTheOnlyNodeHasNoPower) {
  Bench bench(can_rig(1), *Faults::parse("reboot=1"));
  const Instant off = bench.simulated.reboots().at(0).at;
  bench.simulated.advance_to(off + milliseconds(100));
  auto& port = bench.simulated.can(BusIndex(0));
  port.send(frame(0x201, {1}));
  bench.run_for(milliseconds(10));
  EXPECT_EQ(port.queued(), 0U) << "it is on the wire all the time";
  const auto seen = frames(bench);
  EXPECT_GT(seen.size(), 40U);
  EXPECT_EQ(seen.back(), "201#01 not acknowledged");
  bench.run_for(milliseconds(195));
  EXPECT_EQ(frames(bench).back(), "701#00") << "the frame has arrived, the boot-up message after it";
}

TEST(CanBus, BusOffLosesTheQueueAndEndsAfter100MillisecondsBothToldByErrorFrames) {
  Bench bench(can_rig(1));
  auto& port = bench.simulated.can(BusIndex(0));
  for (int i = 0; i < 5; ++i) port.send(frame(0x201, {i}));
  bench.run_for(microseconds(50));
  ASSERT_TRUE(bench.simulated.strike(BusIndex(0), LineFault::bus_off));
  EXPECT_EQ(port.state(), drivers::CanState::bus_off);
  EXPECT_EQ(port.queued(), 0U);
  EXPECT_EQ(port.send(frame(0x201, {9})), SendStatus::down);
  CanFrame told;
  ASSERT_TRUE(port.receive(told));
  EXPECT_EQ(told.kind, CanFrame::Kind::error);
  EXPECT_EQ(told.id, 0x40);
  bench.run_for(milliseconds(99));
  EXPECT_EQ(port.state(), drivers::CanState::bus_off);
  bench.run_for(milliseconds(1));
  EXPECT_EQ(port.state(), drivers::CanState::active);
  ASSERT_TRUE(port.receive(told));
  EXPECT_EQ(told.id, 0x100);
  EXPECT_EQ(port.send(frame(0x202, {1})), SendStatus::accepted);
  bench.run_for(milliseconds(1));
  EXPECT_EQ(port.queued(), 0U);
  EXPECT_THAT(frames(bench), ElementsAre("201#00 cut off", "202#01"));
}

TEST(CanBus, AJammedQueueFillsStallsAndEmptiesAfterwards) {
  Bench bench(can_rig(1));
  auto& port = bench.simulated.can(BusIndex(0));
  ASSERT_TRUE(bench.simulated.strike(BusIndex(0), LineFault::full));
  for (int i = 0; i < 10; ++i) EXPECT_EQ(port.send(frame(0x201, {i})), SendStatus::accepted);
  EXPECT_EQ(port.send(frame(0x201, {10})), SendStatus::busy);
  bench.run_for(milliseconds(49));
  EXPECT_EQ(port.queued(), 10U);
  EXPECT_EQ(port.state(), drivers::CanState::active);
  bench.run_for(milliseconds(500));
  EXPECT_EQ(port.queued(), 0U);
  EXPECT_EQ(port.state(), drivers::CanState::active);
}

TEST(CanBus, FramesThatNobodyAcknowledgesStallTheWireAfter70Milliseconds) {
  Bench bench(can_rig(1), *Faults::parse("dead=1"));
  auto& port = bench.simulated.can(BusIndex(0));
  port.send(frame(0x77F, {5}));
  bench.run_for(milliseconds(69));
  EXPECT_EQ(port.state(), drivers::CanState::active);
  bench.run_for(milliseconds(2));
  EXPECT_EQ(port.state(), drivers::CanState::stalled);
}

TEST(CanBus, AnAdapterThatIsPulledOutHearsNothingAndComesBackAfterASecond) {
  Bench bench(can_rig(3));
  auto& port = bench.simulated.can(BusIndex(0));
  ASSERT_TRUE(bench.simulated.strike(BusIndex(0), LineFault::unplug));
  EXPECT_EQ(port.state(), drivers::CanState::down);
  EXPECT_EQ(port.send(frame(0x201, {1})), SendStatus::down);
  bench.run_for(milliseconds(999));
  CanFrame heard;
  EXPECT_FALSE(port.receive(heard)) << "the nodes' heartbeats of this second are not heard";
  bench.run_for(milliseconds(1));
  EXPECT_EQ(port.state(), drivers::CanState::active);
  bench.run_for(milliseconds(1000));
  EXPECT_TRUE(port.receive(heard));
}

TEST(CanBus, AFaultDuringAFaultLastsUntilTheLaterEnd) {
  Bench bench(can_rig(1));
  auto& port = bench.simulated.can(BusIndex(0));
  bench.simulated.strike(BusIndex(0), LineFault::unplug);
  bench.run_for(milliseconds(500));
  bench.simulated.strike(BusIndex(0), LineFault::bus_off);
  bench.run_for(milliseconds(499));
  EXPECT_NE(port.state(), drivers::CanState::active);
  bench.run_for(milliseconds(1));
  EXPECT_EQ(port.state(), drivers::CanState::active);
}

}  // namespace
}  // namespace footlight::sim
