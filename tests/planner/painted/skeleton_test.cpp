// SPDX-License-Identifier: Apache-2.0
#include "planner/painted/skeleton.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

namespace footlight::planner {
namespace {

void fill(PixelSet& set, int x0, int y0, int x1, int y1) {
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) set.at(x, y) = 1;
  }
}

TEST(Skeleton, ABarBecomesItsMiddleRow) {
  PixelSet bar(40, 11);
  fill(bar, 3, 2, 37, 9);
  const PixelSet line = thinned(bar);
  int pixels = 0;
  for (int x = 8; x < 32; ++x) {
    for (int y = 0; y < 11; ++y) pixels += line.at(x, y);
    EXPECT_EQ(line.at(x, 5), 1) << x;
  }
  EXPECT_EQ(pixels, 24);
}

TEST(Skeleton, ForksArePrunedToTheLongestWay) {
  PixelSet lines(30, 20);
  fill(lines, 0, 10, 30, 11);
  fill(lines, 12, 4, 13, 10);
  const auto way = longest_way(lines);
  ASSERT_EQ(way.size(), 30U);
  for (const Point p : way) EXPECT_EQ(p.y, 10.5);
}

TEST(Skeleton, OfSeveralPiecesTheOneWithTheLongestWayIsTaken) {
  PixelSet lines(30, 20);
  fill(lines, 0, 2, 8, 3);
  fill(lines, 5, 10, 29, 11);
  EXPECT_EQ(longest_way(lines).size(), 24U);
  EXPECT_TRUE(longest_way(PixelSet(5, 5)).empty());
}

TEST(Skeleton, ThinningTakesNothingAwayFromBesidesAndKeepsPiecesTogether) {
  EXPECT_TRUE(rc::check([] {
    PixelSet set(24, 24);
    const int boxes = *rc::gen::inRange(1, 5);
    for (int b = 0; b < boxes; ++b) {
      const int x = *rc::gen::inRange(1, 15);
      const int y = *rc::gen::inRange(1, 15);
      fill(set, x, y, x + *rc::gen::inRange(3, 9), y + *rc::gen::inRange(3, 9));
    }
    const PixelSet line = thinned(set);
    for (std::size_t i = 0; i < set.cells.size(); ++i) RC_ASSERT(line.cells[i] <= set.cells[i]);
    RC_ASSERT(components(line, 0).size() <= components(set, 0).size());
  }));
}

}  // namespace
}  // namespace footlight::planner
