// SPDX-License-Identifier: Apache-2.0
#include "config/otsu.hpp"

#include <gtest/gtest.h>

namespace footlight::config {
namespace {

TEST(Otsu, BlackAndWhiteArePartedInTheMiddle) {
  GreyHistogram histogram{};
  histogram[0] = 900;
  histogram[255] = 100;
  EXPECT_EQ(otsu_threshold(histogram), 127);
}

TEST(Otsu, NoiseOfACodecBesideBlackAndWhiteLeavesTheMiddleOfTheGap) {
  GreyHistogram histogram{};
  for (std::size_t grey = 0; grey <= 8; ++grey) histogram[grey] = 1000 >> grey;
  for (std::size_t grey = 240; grey < 256; ++grey) histogram[grey] = 20;
  EXPECT_EQ(otsu_threshold(histogram), (8 + 239) / 2);
}

TEST(Otsu, TwoHumpsArePartedWhereTheClassesVaryMost) {
  // 0: 4 pixels, 1: 4, 2: 1, 3: 1 with means far apart only after 1; computed by hand:
  // t=0: 4*6*(1.5-0)^2 = 54; t=1: 8*2*(2.5-0.5)^2 = 64; t=2: 9*1*(3-0.6667)^2 = 49.
  GreyHistogram histogram{};
  histogram[0] = 4;
  histogram[1] = 4;
  histogram[2] = 1;
  histogram[3] = 1;
  EXPECT_EQ(otsu_threshold(histogram), 1);
}

TEST(Otsu, OneValueAndNoPixelGiveTheMiddle) {
  GreyHistogram histogram{};
  EXPECT_EQ(otsu_threshold(histogram), 127);
  histogram[40] = 7;
  EXPECT_EQ(otsu_threshold(histogram), 127);
}

}  // namespace
}  // namespace footlight::config
