// SPDX-License-Identifier: Apache-2.0
#include "app/paper/stage_words.hpp"

#include <gtest/gtest.h>

namespace footlight::app {
namespace {

const Grid kFloor = *Grid::make(GridKind::square, 60, 40, 0.5);

/// The middle of row 10 of the floor, upstage by so many metres.
double row10_m(double more_m) { return kFloor.centre(Cell{0, 9}).y + more_m; }

TEST(PlaceInWords, CountsStepsFromTheCentreAndFromANamedRow) {
  PlaceWords words;
  words.step_m = 0.6;
  EXPECT_EQ(place_in_words(words, kFloor, {1.8, row10_m(1.2)}), "3 steps stage left of centre, 2 upstage of row 10");
  EXPECT_EQ(place_in_words(words, kFloor, {-0.45, row10_m(-0.3)}),
            "0.75 steps stage right of centre, 0.5 downstage of row 10");
  EXPECT_EQ(place_in_words(words, kFloor, {0.05, row10_m(0.05)}), "on the centre line, on row 10");
  words.language = Language::chinese;
  EXPECT_EQ(place_in_words(words, kFloor, {1.8, row10_m(1.2)}), "中线舞台左侧 3 步，第 10 排往后 2 步");
}

TEST(PlaceInWords, DrillStyleHasYardLinesAndHashes) {
  PlaceWords words;
  words.style = PlaceStyle::drill;
  const double step = kDrillStep_m;
  EXPECT_EQ(place_in_words(words, kFloor, {0, 0}), "on 50 yd ln, on front side line");
  // 45 yard line: eight steps from the 50; front hash: 32 steps from the front side line.
  EXPECT_EQ(place_in_words(words, kFloor, {-10 * step, 30 * step}),
            "Side 1: 2 steps outside 45 yd ln, 2 steps in front of front hash");
  EXPECT_EQ(place_in_words(words, kFloor, {6.5 * step, 33 * step}),
            "Side 2: 1.5 steps inside 45 yd ln, 1 steps behind front hash");
  EXPECT_EQ(place_in_words(words, kFloor, {16 * step, 1 * step}),
            "Side 2: on 40 yd ln, 1 steps behind front side line");
}

TEST(Directions, AreEightAndTheSameForWhoFacesTheAudience) {
  const auto both = [](Point walk) {
    return std::string(text_of(Language::english, direction_of(walk))) + ": " +
           std::string(text_of(Language::english, facing_of(walk)));
  };
  EXPECT_EQ(both({0, 1}), "upstage: backward");
  EXPECT_EQ(both({1, 1}), "upstage left: backward left");
  EXPECT_EQ(both({1, 0.1}), "stage left: to your left");
  EXPECT_EQ(both({1, -1}), "downstage left: forward left");
  EXPECT_EQ(both({0.1, -1}), "downstage: forward");
  EXPECT_EQ(both({-1, -1}), "downstage right: forward right");
  EXPECT_EQ(both({-1, 0}), "stage right: to your right");
  EXPECT_EQ(both({-1, 1}), "upstage right: backward right");
}

TEST(SpokenCount, HasNoTrailingZeros) {
  EXPECT_EQ(spoken_count(17), "17");
  EXPECT_EQ(spoken_count(17.5), "17.5");
  EXPECT_EQ(spoken_count(100), "100");
  EXPECT_EQ(spoken_count(3.33333), "3.33");
}

}  // namespace
}  // namespace footlight::app
