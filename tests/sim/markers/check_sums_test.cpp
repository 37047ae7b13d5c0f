// SPDX-License-Identifier: Apache-2.0
#include "sim/markers/check_sums.hpp"

#include <string_view>

#include <gtest/gtest.h>

namespace footlight::sim {
namespace {

TEST(CheckSums, EachGivesItsPublishedCheckValue) {
  constexpr std::string_view kDigits = "123456789";
  const std::span bytes(reinterpret_cast<const std::uint8_t*>(kDigits.data()), kDigits.size());
  EXPECT_EQ(crc16_ccitt(bytes), 0x29B1);
  EXPECT_EQ(crc16_modbus(bytes), 0x4B37);
  EXPECT_EQ(crc32_ieee(bytes), 0xCBF43926U);
}

}  // namespace
}  // namespace footlight::sim
