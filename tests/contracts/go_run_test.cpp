// SPDX-License-Identifier: Apache-2.0
#include "tests/contracts/go_run.hpp"

#include <gtest/gtest.h>

namespace footlight::contracts {
namespace {

TEST(GoOnAFloor, LightsEveryNodeWithinAMillisecondOfTheOthersOnAllBuses) {
  const std::vector<FloorBus> mixed{
      {BusKind::can, 500'000, 32}, {BusKind::serial, 115'200, 16}, {BusKind::modbus_rtu, 115'200, 16}};
  const GoRun run = go_on(mixed);
  EXPECT_EQ(run.lit, 64);
  EXPECT_LE(run.within_bus, milliseconds(1)) << "a latch is one frame";
  EXPECT_LE(run.across_buses, milliseconds(1)) << "every bus begins its own so that the last bit is in time";
  EXPECT_GE(run.go_to_last_lamp, run.notice);
  EXPECT_LE(run.go_to_last_lamp, run.notice + milliseconds(1));
}

TEST(GoOnAFloor, OverTcpNodesFollowEachOtherAndTheLastIsWithinAHundredthOfASecond) {
  const GoRun run = go_on({{BusKind::modbus_tcp, 100'000'000, 32}});
  EXPECT_EQ(run.lit, 32);
  EXPECT_GT(run.within_bus, Duration{}) << "there is no wire that all of them share";
  EXPECT_LE(run.within_bus, milliseconds(10));
}

}  // namespace
}  // namespace footlight::contracts
