// SPDX-License-Identifier: Apache-2.0
#include "core/rig.hpp"

#include <tuple>

#include <gtest/gtest.h>

namespace footlight {
namespace {

TEST(BusKindText, IsWhatFilesAndPeopleSay) {
  EXPECT_EQ(to_text(BusKind::serial), "serial");
  EXPECT_EQ(to_text(BusKind::modbus_rtu), "modbus-rtu");
  EXPECT_EQ(to_text(BusKind::modbus_tcp), "modbus-tcp");
  EXPECT_EQ(to_text(BusKind::can), "can");
}

TEST(Bus, CountsTheBitsOfACharacter) {
  Bus bus;
  EXPECT_EQ(bus.bits_per_character(), 10) << "serial: 8N1";
  bus.kind = BusKind::modbus_rtu;
  EXPECT_EQ(bus.bits_per_character(), 11) << "RTU: 8E1";
  for (const auto& [characters, text, bits] : {std::tuple{Characters::n1, "8N1", 10},
                                               {Characters::n2, "8N2", 11},
                                               {Characters::e1, "8E1", 11},
                                               {Characters::o1, "8O1", 11}}) {
    bus.line.characters = characters;
    EXPECT_EQ(bus.bits_per_character(), bits);
    EXPECT_EQ(to_text(characters), text);
  }
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
