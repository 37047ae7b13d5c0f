// SPDX-License-Identifier: Apache-2.0
#include "planner/motion/lanes.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace footlight::planner::lanes {
namespace {

TEST(LanesExp, IsThatOfTheLibraryWithinTwoUnitsOfTheLastPlace) {
  for (double x = -690; x <= 690; x += 0.0137) {
    ASSERT_NEAR(exp(x) / std::exp(x), 1, 2 * std::numeric_limits<double>::epsilon()) << x;
  }
  EXPECT_EQ(exp(0), 1);
}

TEST(LanesExp, StaysFiniteAndAboveNothingBeyondItsRange) {
  EXPECT_EQ(exp(-1e9), exp(-700));
  EXPECT_GT(exp(-1e9), 0);
  EXPECT_EQ(exp(1e9), exp(700));
  EXPECT_EQ(exp(-std::numeric_limits<double>::infinity()), exp(-700));
}

TEST(LanesSineCosine, AreThoseOfTheLibrary) {
  for (double angle_rad = -std::numbers::pi; angle_rad <= std::numbers::pi; angle_rad += 0.00037) {
    const SineCosine found = sine_cosine(angle_rad);
    ASSERT_NEAR(found.sine, std::sin(angle_rad), 2e-15) << angle_rad;
    ASSERT_NEAR(found.cosine, std::cos(angle_rad), 2e-15) << angle_rad;
  }
}

}  // namespace
}  // namespace footlight::planner::lanes
