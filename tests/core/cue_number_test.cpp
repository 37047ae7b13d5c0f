// SPDX-License-Identifier: Apache-2.0
#include "core/cue_number.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"

namespace footlight {
namespace {

CueNumber cue(std::string_view text) { return CueNumber::parse(text).value(); }

TEST(CueNumber, TwelvePointTenEqualsTwelvePointOne) { EXPECT_EQ(cue("12.10"), cue("12.1")); }

TEST(CueNumber, OrdersAsDecimals) {
  EXPECT_LT(cue("12"), cue("12.05"));
  EXPECT_LT(cue("12.05"), cue("12.1"));
  EXPECT_LT(cue("12.1"), cue("12.5"));
  EXPECT_LT(cue("12.5"), cue("13"));
  EXPECT_LT(cue("2"), cue("10"));
  EXPECT_LT(cue("0"), cue("0.000001"));
}

TEST(CueNumber, IsExactWhereADoubleIsNot) {
  EXPECT_NE(cue("999999999.000001"), cue("999999999.000002"));
  EXPECT_EQ(cue("0.1").to_text(), "0.1");
}

TEST(CueNumber, IsWrittenInItsShortestForm) {
  EXPECT_EQ(cue("12.10").to_text(), "12.1");
  EXPECT_EQ(cue("12.0").to_text(), "12");
  EXPECT_EQ(cue("012").to_text(), "12");
  EXPECT_EQ(cue("0").to_text(), "0");
  EXPECT_EQ(cue("3.000001").to_text(), "3.000001");
  EXPECT_EQ(CueNumber{}.to_text(), "0");
}

TEST(CueNumber, IsRefusedWhenItIsNone) {
  for (const char* text : {"", ".", "1.", ".5", "-1", "+1", "1,5", "1e3", "1.2.3", " 1", "1 ", "1000000000",
                           "1.0000001", "A", "1.A", "0x1"}) {
    EXPECT_EQ(CueNumber::parse(text), std::nullopt) << text;
  }
}

TEST(CueNumberProperty, IsReadBack) {
  const bool held = rc::check([](std::uint64_t seed) {
    Rng rng(seed);
    std::string text = std::to_string(rng.below(1'000'000'000));
    const std::uint64_t decimals = rng.below(7);
    if (decimals > 0) text += ".";
    for (std::uint64_t k = 0; k < decimals; ++k) text += static_cast<char>('0' + rng.below(10));
    const CueNumber number = cue(text);
    RC_ASSERT(cue(number.to_text()) == number);
    RC_ASSERT(number.to_text().size() <= text.size());
  });
  EXPECT_TRUE(held);
}

}  // namespace
}  // namespace footlight
