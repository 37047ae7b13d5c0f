// SPDX-License-Identifier: Apache-2.0
#include "sim/simulated_rig.hpp"

#include <algorithm>
#include <array>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "can_frame.hpp"
#include "serial_frame.hpp"
#include "small_rig.hpp"

namespace footlight::sim {
namespace {

using drivers::CanFrame;
using drivers::SendStatus;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A bus of each kind with four nodes each.
Rig mixed_rig() {
  Rig rig;
  const std::array kinds{BusKind::serial, BusKind::modbus_rtu, BusKind::modbus_tcp, BusKind::can};
  for (std::size_t bus = 0; bus < kinds.size(); ++bus) {
    Rig one = small_rig(kinds[bus], 4, 8, kinds[bus] == BusKind::can ? 500'000 : 115'200);
    one.buses[0].name = "b" + std::to_string(bus);
    rig.buses.push_back(one.buses[0]);
    for (Node& node : one.nodes) {
      node.bus = BusIndex::of(bus);
      node.name = one.buses[0].name + node.name;
      rig.nodes.push_back(node);
    }
  }
  return rig;
}

/// Twelve seconds of traffic on the first `buses` buses of the mixed rig.
void play(Bench& bench, std::size_t buses) {
  for (int i = 0; i < 600; ++i) {
    const auto sequence = static_cast<std::uint8_t>(1 + i % 240);
    const auto address = static_cast<std::uint8_t>(1 + i % 4);
    bench.simulated.serial(BusIndex(0)).write(serial_frame({1, 1, address, 9, sequence, 0, 1, 2, 3, 4, 5, 6, 7, 8}));
    if (buses > 1) {
      const drivers::ModbusRequest request{address, 3, 0x40, 6, {}};
      bench.simulated.modbus(BusIndex(1)).submit(request);
      bench.simulated.modbus(BusIndex(2)).submit(request);
      bench.simulated.can(BusIndex(3)).send(frame(0x000, {1, 0}));
      bench.simulated.can(BusIndex(3)).send(frame(0x200 + address, {1, 2, 3, 4, 5, 6, 7, i & 0xFF}));
      bench.simulated.can(BusIndex(3)).send(frame(0x080, {sequence}));
    }
    bench.run_for(milliseconds(20));
    for (CanFrame received; bench.simulated.can(BusIndex(3)).receive(received);) continue;
  }
}

Faults all_faults() { return *Faults::parse("loss=5%,corrupt=5%,duplicate=5%,delay=3ms,reboot=6,dead=2"); }

TEST(SimulatedRig, CanNodesShowWhatWasPreloadedAtTheSync) {
  Bench bench(small_rig(BusKind::can, 2, 3, 500'000));
  auto& port = bench.simulated.can(BusIndex(0));
  EXPECT_THAT(bench.shown(0, 3), ElementsAre(255, 255, 255));
  ASSERT_EQ(port.send(frame(0x000, {1, 0})), SendStatus::accepted);
  ASSERT_EQ(port.send(frame(0x201, {7, 8, 9})), SendStatus::accepted);
  bench.run_for(milliseconds(1));
  EXPECT_THAT(bench.shown(0, 3), ElementsAre(255, 255, 255));
  ASSERT_EQ(port.send(frame(0x080, {17})), SendStatus::accepted);
  bench.run_for(milliseconds(8));
  EXPECT_THAT(bench.shown(0, 3), ElementsAre(7, 8, 9));
  EXPECT_THAT(bench.shown(1, 3), ElementsAre(255, 255, 255));
  std::vector<CanFrame> received;
  for (CanFrame one; port.receive(one);) {
    if (one.id < 0x700) received.push_back(one);
  }
  ASSERT_EQ(received.size(), 2U);
  if (received[0].id == 0x182) std::swap(received[0], received[1]);
  // CRC-16/CCITT-FALSE of 07 08 09 is 0x518C, worked out apart.
  EXPECT_EQ(received[0], frame(0x181, {17, 1, 0x8C, 0x51, 1, 0, 0, 0}));
  EXPECT_EQ(received[1].data[0], 17);
  EXPECT_EQ(received[1].data[1], 0) << "nothing was pending, so it is still in BOOT";
}

TEST(SimulatedRig, TheSameSeedGivesTheSameTraceByteForByte) {
  Bench one(mixed_rig(), all_faults(), 42);
  Bench two(mixed_rig(), all_faults(), 42);
  play(one, 4);
  play(two, 4);
  EXPECT_GT(one.trace.str().size(), 100'000U);
  EXPECT_TRUE(one.trace.str() == two.trace.str());
}

TEST(SimulatedRig, AnotherSeedGivesAnotherTrace) {
  Bench one(mixed_rig(), all_faults(), 42);
  Bench two(mixed_rig(), all_faults(), 43);
  play(one, 4);
  play(two, 4);
  EXPECT_FALSE(one.trace.str() == two.trace.str());
}

TEST(SimulatedRig, TheTraceIsInTheOrderOfTime) {
  Bench bench(mixed_rig(), all_faults(), 42);
  play(bench, 4);
  double last = 0;
  for (const auto& line : bench.lines()) {
    const double at = std::stod(line);
    ASSERT_GE(at, last) << line;
    last = at;
  }
}

TEST(SimulatedRig, TrafficOnOneBusDoesNotChangeTheFaultsOfAnother) {
  Bench alone(mixed_rig(), all_faults(), 42);
  Bench together(mixed_rig(), all_faults(), 42);
  play(alone, 1);
  play(together, 4);
  const auto of_first_bus = [](const Bench& bench) {
    std::vector<std::string> kept;
    for (const auto& line : bench.lines()) {
      if (line.find(" b0 ") != std::string::npos) kept.push_back(line);
    }
    return kept;
  };
  EXPECT_GT(of_first_bus(alone).size(), 500U);
  EXPECT_EQ(of_first_bus(alone), of_first_bus(together));
}

TEST(SimulatedRig, TheTraceMakesNoDifferenceToWhatHappens) {
  Bench traced(mixed_rig(), all_faults(), 42);
  ManualClock clock;
  SimulatedRig silent(mixed_rig(), all_faults(), 42, clock, nullptr);
  silent.set_show(kStart + std::chrono::seconds(1), std::chrono::seconds(10));
  for (int i = 1; i < 200; ++i) {
    for (SimulatedRig* rig : {&traced.simulated, &silent}) {
      rig->can(BusIndex(3)).send(frame(0x080, {i}));
      rig->advance_to(kStart + milliseconds(20 * i));
    }
  }
  EXPECT_EQ(traced.simulated.use(BusIndex(3)).busy, silent.use(BusIndex(3)).busy);
  EXPECT_EQ(traced.simulated.next_event(), silent.next_event());
}

TEST(SimulatedRig, ARebootedNodeIsDarkForThreeHundredMillisecondsAndComesBackWithoutGuidance) {
  Bench bench(small_rig(BusKind::can, 3, 1, 500'000), *Faults::parse("reboot=1"), 9);
  ASSERT_EQ(bench.simulated.reboots().size(), 1U);
  const auto [node, at] = bench.simulated.reboots()[0];
  EXPECT_GE(at, kStart + std::chrono::seconds(1));
  EXPECT_LT(at, kStart + std::chrono::seconds(11));
  bench.simulated.advance_to(at - Duration(1));
  EXPECT_EQ(bench.simulated.shown(node, 0), 255);
  bench.run_for(Duration(1));
  EXPECT_EQ(bench.simulated.shown(node, 0), 0);
  auto& port = bench.simulated.can(BusIndex(0));
  for (CanFrame received; port.receive(received);) continue;
  bench.simulated.advance_to(at + milliseconds(300) - Duration(1));
  EXPECT_EQ(bench.simulated.shown(node, 0), 0);
  bench.run_for(Duration(1));
  EXPECT_EQ(bench.simulated.shown(node, 0), 255);
  bench.run_for(milliseconds(1));
  const auto id = 0x701 + static_cast<int>(node.value());
  std::vector<CanFrame> of_node;
  for (CanFrame received; port.receive(received);) {
    if (received.id == id) of_node.push_back(received);
  }
  EXPECT_THAT(of_node, ElementsAre(frame(id, {0}))) << "silent while off, then the boot-up message";
}

TEST(SimulatedRig, RebootsFallIntoTheShowAndDeadNodesAreSpared) {
  Bench bench(mixed_rig(), *Faults::parse("reboot=200,dead=7"), 9);
  EXPECT_EQ(bench.simulated.reboots().size(), 200U);
  const auto& dead = bench.simulated.dead();
  EXPECT_EQ(std::set<NodeIndex>(dead.begin(), dead.end()).size(), 7U);
  for (const Reboot& reboot : bench.simulated.reboots()) {
    EXPECT_GE(reboot.at, kStart + std::chrono::seconds(1));
    EXPECT_LT(reboot.at, kStart + std::chrono::seconds(11));
    EXPECT_FALSE(std::binary_search(dead.begin(), dead.end(), reboot.node));
  }
  play(bench, 4);  // restarts within restarts
  bench.run_for(std::chrono::seconds(2));
  for (const Reboot& reboot : bench.simulated.reboots()) EXPECT_NE(bench.simulated.shown(reboot.node, 0), 0);
}

TEST(SimulatedRig, DeadNodesNeverLightAndNeverAnswer) {
  Bench bench(small_rig(BusKind::serial, 3, 1, 115'200), *Faults::parse("dead=1"), 9);
  ASSERT_EQ(bench.simulated.dead().size(), 1U);
  const NodeIndex dead = bench.simulated.dead()[0];
  const auto address = static_cast<std::uint8_t>(dead.value() + 1);
  EXPECT_EQ(bench.simulated.shown(dead, 0), 0);
  bench.simulated.serial(BusIndex(0)).write(serial_frame({1, 4, address, 9, 0}));
  bench.run_for(milliseconds(50));
  EXPECT_EQ(bench.lines().size(), 1U) << "the question alone";
}

TEST(SimulatedRig, LatchesAreTraced) {
  Bench bench(small_rig(BusKind::can, 1, 1, 500'000));
  auto& port = bench.simulated.can(BusIndex(0));
  port.send(frame(0x000, {1, 0}));
  port.send(frame(0x201, {7}));
  port.send(frame(0x080, {17}));
  bench.run_for(milliseconds(1));
  EXPECT_THAT(bench.trace.str(), HasSubstr("b > 080#11\n"));
  EXPECT_THAT(bench.trace.str(), HasSubstr("b * - n1 latched 17\n"));
}

TEST(SimulatedRig, AnEmptyRigDoesNothing) {
  Bench bench(Rig{}, *Faults::parse("reboot=3,dead=3"));
  EXPECT_EQ(bench.simulated.next_event(), kNever);
  bench.run_for(std::chrono::seconds(1));
  EXPECT_TRUE(bench.simulated.reboots().empty());
}

}  // namespace
}  // namespace footlight::sim
