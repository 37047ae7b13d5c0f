// SPDX-License-Identifier: Apache-2.0
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/driver.hpp"
#include "drivers/leading.hpp"

namespace footlight::drivers {
namespace {

std::uint16_t crc_of(std::string_view text) { return looks_crc(std::vector<LookIndex>(text.begin(), text.end())); }

TEST(LooksCrc, GivesTheKnownAnswers) {
  EXPECT_EQ(crc_of("123456789"), 0x29B1);  // CRC RevEng catalogue, CRC-16/IBM-3740 (CCITT-FALSE)
  EXPECT_EQ(crc_of(""), 0xFFFF);
  EXPECT_EQ(crc_of("A"), 0xB915);
}

TEST(LooksCrc, TellsEverySingleChangedLook) {
  std::vector<LookIndex> looks(32, 7);
  const std::uint16_t right = looks_crc(looks);
  for (LookIndex& look : looks) {
    for (int other = 0; other < 256; ++other) {
      if (other == 7) continue;
      look = static_cast<LookIndex>(other);
      EXPECT_NE(looks_crc(looks), right);
    }
    look = 7;
  }
}

TEST(LooksCrc, TellsExchangedChannels) {
  EXPECT_NE(looks_crc(std::vector<LookIndex>{1, 2}), looks_crc(std::vector<LookIndex>{2, 1}));
}

TEST(LeadingByte, IsNeverZeroAndAnotherOneForTheNextEpoch) {
  for (int plan = 0; plan < 256; ++plan) {
    for (std::uint32_t epoch = 0; epoch < 600; ++epoch) {
      const auto byte = leading_byte(static_cast<std::uint8_t>(plan), epoch);
      ASSERT_NE(byte, 0);
      ASSERT_NE(byte, leading_byte(static_cast<std::uint8_t>(plan), epoch + 1)) << plan << " " << epoch;
    }
  }
}

}  // namespace
}  // namespace footlight::drivers
