// SPDX-License-Identifier: Apache-2.0
#include "core/look.hpp"

#include <gtest/gtest.h>

namespace footlight {
namespace {

TEST(ColourText, IsReadBack) {
  EXPECT_EQ(to_text(Colour{0x7C, 0xFC, 0x00}), "#7CFC00");
  EXPECT_EQ(parse_colour("#7cfc00"), (Colour{0x7C, 0xFC, 0x00}));
  for (int v = 0; v < 256; ++v) {
    const auto c = static_cast<std::uint8_t>(v);
    const Colour colour{c, static_cast<std::uint8_t>(255 - v), static_cast<std::uint8_t>(v ^ 0x5A)};
    EXPECT_EQ(parse_colour(to_text(colour)), colour);
  }
}

TEST(ColourText, IsRefusedWhenItIsNone) {
  for (const char* text : {"", "7CFC00", "#7CFC0", "#7CFC000", "#7CFC0G", "#-7CFC0", "# 7CFC0", "#0x7CF", "red"}) {
    EXPECT_EQ(parse_colour(text), std::nullopt) << text;
  }
}

TEST(EffectText, IsReadBackAndHasTheNumbersOfTheWire) {
  EXPECT_EQ(static_cast<int>(Effect::steady), 0);
  EXPECT_EQ(static_cast<int>(Effect::count_down), 4);
  for (int k = 0; k <= 4; ++k) {
    const auto effect = static_cast<Effect>(k);
    EXPECT_EQ(effect_from(to_text(effect)), effect);
  }
  EXPECT_EQ(to_text(Effect::double_blink), "double-blink");
  EXPECT_EQ(effect_from("strobe"), std::nullopt);
  EXPECT_EQ(effect_from(""), std::nullopt);
}

TEST(Look, NoGuidanceIsDimSteadyAmberAndNotDark) {
  EXPECT_EQ(no_guidance_look(), (Look{{255, 191, 0}, Effect::steady, 40}));
  EXPECT_NE(kNoGuidance, kDark);
}

}  // namespace
}  // namespace footlight
