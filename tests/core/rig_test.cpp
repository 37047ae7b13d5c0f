// SPDX-License-Identifier: Apache-2.0
#include "core/rig.hpp"

#include <gtest/gtest.h>

namespace footlight {
namespace {

TEST(BusKindText, IsWhatFilesAndPeopleSay) {
  EXPECT_EQ(to_text(BusKind::serial), "serial");
  EXPECT_EQ(to_text(BusKind::modbus_rtu), "modbus-rtu");
  EXPECT_EQ(to_text(BusKind::modbus_tcp), "modbus-tcp");
  EXPECT_EQ(to_text(BusKind::can), "can");
}

TEST(Bus, IsSimulatedByItsUrl) {
  Bus bus;
  bus.url = "sim://can";
  EXPECT_TRUE(bus.simulated());
  bus.url = "can://sim://0";
  EXPECT_FALSE(bus.simulated());
  bus.url = "";
  EXPECT_FALSE(bus.simulated());
}

}  // namespace
}  // namespace footlight
