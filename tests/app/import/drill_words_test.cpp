// SPDX-License-Identifier: Apache-2.0
#include "app/import/drill_words.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "app/paper/stage_words.hpp"
#include "core/rng.hpp"
#include "tests/support/full.hpp"
#include "tests/support/mutated.hpp"

namespace footlight::app {
namespace {

double across(const char* words) { return side_to_side(words).steps.value_or(-999); }
double back(const char* words, DrillField field = {}) { return front_to_back(words, field).steps.value_or(-999); }
std::string wrong(const DrillSteps& told) {
  EXPECT_FALSE(told.steps);
  return std::to_string(told.offset) + ": " + told.error + " (" + told.hint + ")";
}

TEST(SideToSide, AsDrillProgramsPrintIt) {
  EXPECT_EQ(across("Side 1: 2.5 steps outside 40 yd ln"), -18.5);
  EXPECT_EQ(across("Side 2: 4.0 steps inside 35 yd ln"), 20);
  EXPECT_EQ(across("Side 1: On 45 yd ln"), -8);
  EXPECT_EQ(across("On 50 yd ln"), 0);
  EXPECT_EQ(across("Side 2: 1.75 steps outside 50 yd ln"), 1.75);
  EXPECT_EQ(across("Side 1: On 0 yd ln"), -80);
}

TEST(SideToSide, InOtherWords) {
  EXPECT_EQ(across("2.5 steps outside Side 1 40 yd ln"), -18.5);
  EXPECT_EQ(across("4 Steps Inside 35 (Side 2)"), 20);
  EXPECT_EQ(across("Right: on 40"), 16);
  EXPECT_EQ(across("side a: 2 out 45"), -10);
  EXPECT_EQ(across("0.0 steps inside 50 yard line"), 0);
}

TEST(SideToSide, WhatIsAmbiguousOrWrongIsToldWithItsPlace) {
  const std::string hint = " (for example: Side 1: 2.5 steps outside 40 yd ln)";
  EXPECT_EQ(wrong(side_to_side("2 steps outside 40 yd ln")),
            "0: no side is told (Side 1 or Side 2, unless on the 50 yard line)");
  EXPECT_EQ(wrong(side_to_side("Side 1: 2 steps outside 42 yd ln")), "24: 42 is no yard line (0, 5, 10 .. 50)");
  EXPECT_EQ(wrong(side_to_side("Side 1: 2 steps inside 50 yd ln")),
            "8: 2 steps inside the 50 are on the other side (tell it from that side: outside the yard line there)");
  EXPECT_EQ(wrong(side_to_side("Side 1: 2 steps beside 40")),
            "16: \"beside\" stands where \"inside\" or \"outside\" belongs" + hint);
  EXPECT_EQ(wrong(side_to_side("Side 3: on 40")),
            "0: \"side\" stands where a number of steps, or \"on\", belongs" + hint);
  EXPECT_EQ(wrong(side_to_side("Side 1: on")), "10: the words end where the number of a yard line belongs" + hint);
  EXPECT_EQ(wrong(side_to_side("Side 1: on 40 yd ln and 2")), "20: \"and\" stands where nothing more belongs" + hint);
  EXPECT_EQ(wrong(side_to_side("")), "0: the words end where a number of steps, or \"on\", belongs" + hint);
}

TEST(FrontToBack, AsDrillProgramsPrintIt) {
  EXPECT_EQ(back("8.0 steps behind Front Hash (HS)"), 36);
  EXPECT_EQ(back("4.0 steps in front of Back Hash (HS)"), 52);
  EXPECT_EQ(back("4.0 steps in frnt of Back hash (CH)"), 48);
  EXPECT_EQ(back("0.25 steps in front of Front side line"), -0.25);
  EXPECT_EQ(back("On Front Sideline"), 0);
  EXPECT_EQ(back("On Back side line"), 84);
  EXPECT_EQ(back("12 behind home hash", {HashLines::high_school, FieldDepth::grid}), 40);
}

TEST(FrontToBack, OnAFieldAsItIsMeasured) {
  const DrillField measured{HashLines::college, FieldDepth::measured};
  EXPECT_EQ(back("On Front Hash (CH)", measured), 32);
  EXPECT_NEAR(back("On Back Hash (CH)", measured), 53 + 1.0 / 3, 1e-9);
  EXPECT_NEAR(back("On Front Hash (HS)", measured), 28 + 4.0 / 9, 1e-9);
  EXPECT_NEAR(back("On Back side line", measured), 85 + 1.0 / 3, 1e-9);
}

TEST(FrontToBack, SaysWhenTheHashIsAssumed) {
  EXPECT_TRUE(front_to_back("On Front Hash", {}).hash_assumed);
  EXPECT_FALSE(front_to_back("On Front Hash (HS)", {}).hash_assumed);
  EXPECT_FALSE(front_to_back("On Front side line", {}).hash_assumed);
}

TEST(FrontToBack, WhatIsAmbiguousOrWrongIsToldWithItsPlace) {
  const std::string hint = " (for example: 8.0 steps behind Front Hash (HS))";
  EXPECT_EQ(wrong(front_to_back("8 steps Front Hash", {})),
            "8: \"front\" stands where \"behind\" or \"in front of\" belongs" + hint);
  EXPECT_EQ(wrong(front_to_back("8 steps behind Hash", {})),
            "15: \"hash\" stands where a hash or side line, front or back, belongs" + hint);
  EXPECT_EQ(wrong(front_to_back("8 steps behind Front Hash (NFL)", {})),
            "27: \"nfl\" stands where (HS), (CH) or nothing more belongs" + hint);
  EXPECT_EQ(wrong(front_to_back("101 steps behind Front Hash", {})), "0: not 0 to 100 steps" + hint);
}

/// What the dot sheets say in drill words is understood, to the quarter of a step that they tell.
TEST(DrillWords, OfTheDotSheetsAreUnderstood) {
  const Grid grid = *Grid::make(GridKind::square, 200, 100, kDrillStep_m);
  Rng rng(3);
  for (int k = 0; k < 2'000; ++k) {
    const Point at{(160 * rng.uniform() - 80) * kDrillStep_m, (85 * rng.uniform()) * kDrillStep_m};
    const std::string words = place_in_words({Language::english, PlaceStyle::drill, kDrillStep_m}, grid, at);
    const std::size_t comma = words.find(", ");
    const auto x = side_to_side(words.substr(0, comma));
    const auto y = front_to_back(words.substr(comma + 2), {HashLines::college, FieldDepth::measured});
    ASSERT_TRUE(x.steps && y.steps) << words << ": " << x.error << y.error;
    EXPECT_NEAR(*x.steps, at.x / kDrillStep_m, 0.126) << words;
    EXPECT_NEAR(*y.steps, at.y / kDrillStep_m, 0.126) << words;
  }
}

TEST(DrillWords, MutationsAreSurvived) {
  for (std::uint64_t seed = 0; seed < test::tries<std::uint64_t>(5'000, 200'000); ++seed) {
    const auto side = side_to_side(test::mutated("Side 1: 2.5 steps outside 40 yd ln", Rng(seed), " :0159.-eSo"));
    EXPECT_TRUE(side.steps ? std::abs(*side.steps) <= 180 : !side.error.empty());
    const auto depth = front_to_back(test::mutated("8.0 steps behind Front Hash (HS)", Rng(seed), " ()0159.-e"), {});
    EXPECT_TRUE(depth.steps ? std::abs(*depth.steps) <= 184 : !depth.error.empty());
  }
}

}  // namespace
}  // namespace footlight::app
