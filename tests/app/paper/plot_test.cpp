// SPDX-License-Identifier: Apache-2.0
#include "app/paper/plot.hpp"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace footlight::app {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(Ticks, AreRoundAndCoverTheRange) {
  EXPECT_THAT(ticks_of(0, 10, 5), ElementsAre(0, 2, 4, 6, 8, 10));
  EXPECT_THAT(ticks_of(0, 0.9, 5), ElementsAre(0, 0.2, 0.4, 0.6000000000000001, 0.8, 1));
  EXPECT_THAT(ticks_of(3, 480, 5), ElementsAre(0, 100, 200, 300, 400, 500));
}

TEST(Plot, LinesDifferInColourAndInDashesAndGapsStayGaps) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  Plot plot{"t", "x", "y", {{"a", {0, 1, 2, 3}, {1, none, 2, 3}}, {"b", {0, 3}, {0, 1}}}, 0.5, "limit", true, false};
  const std::string svg = plot_svg(plot, 400, 200);
  EXPECT_THAT(svg, HasSubstr("<svg"));
  EXPECT_THAT(svg, HasSubstr("stroke-dasharray"));
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_TRUE(svg == plot_svg(plot, 400, 200)) << "the same plot gives the same bytes";
}

TEST(Plot, OfNothingSaysSo) {
  Plot plot{"t", "x", "y", {{"a", {}, {}}}, {}, "", true, false};
  EXPECT_THAT(plot_svg(plot, 400, 200), HasSubstr("<svg"));
}

}  // namespace
}  // namespace footlight::app
