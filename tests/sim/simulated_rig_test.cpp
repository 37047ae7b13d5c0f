// SPDX-License-Identifier: Apache-2.0
#include "sim/simulated_rig.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "small_rig.hpp"

namespace footlight::sim {
namespace {

using drivers::CanFrame;
using drivers::ModbusReply;
using drivers::ModbusRequest;
using drivers::SendStatus;
using ::testing::ElementsAre;

CanFrame frame(int id, std::initializer_list<int> bytes) {
  CanFrame made{static_cast<std::uint16_t>(id), static_cast<std::uint8_t>(bytes.size()), {}};
  std::size_t i = 0;
  for (const int byte : bytes) made.data[i++] = static_cast<std::uint8_t>(byte);
  return made;
}

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

}  // namespace
}  // namespace footlight::sim
