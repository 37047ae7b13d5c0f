// SPDX-License-Identifier: Apache-2.0
#include "planner/painted/raster.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck.h>

namespace footlight::planner {
namespace {

PixelSet random_set() {
  const int width = *rc::gen::inRange(1, 18);
  const int height = *rc::gen::inRange(1, 18);
  PixelSet set(width, height);
  for (auto& cell : set.cells) cell = *rc::gen::inRange(0, 6) == 0 ? 1 : 0;
  return set;
}

TEST(Raster, TheNearestPixelOfASetIsNoFartherThanAnyOther) {
  EXPECT_TRUE(rc::check([] {
    const PixelSet set = random_set();
    const NearestPixels found = nearest_pixels(set);
    for (int y = 0; y < set.height; ++y) {
      for (int x = 0; x < set.width; ++x) {
        double least = INFINITY;
        for (int v = 0; v < set.height; ++v) {
          for (int u = 0; u < set.width; ++u) {
            if (set.at(u, v) != 0) least = std::min(least, std::hypot(u - x, v - y));
          }
        }
        if (std::isinf(least)) {
          RC_ASSERT(found.pixel.at(x, y) == -1);
          continue;
        }
        RC_ASSERT(std::abs(found.distance_px.at(x, y) - least) < 1e-9);
        const int u = found.pixel.at(x, y) % set.width;
        const int v = found.pixel.at(x, y) / set.width;
        RC_ASSERT(set.at(u, v) != 0);
        RC_ASSERT(std::abs(std::hypot(u - x, v - y) - least) < 1e-9);
      }
    }
  }));
}

TEST(Raster, PixelsHangTogetherOverCornersAndTheLargestPieceComesFirst) {
  PixelSet set(8, 4);
  for (const auto& [x, y] : {std::pair{0, 0}, {4, 0}, {5, 1}, {6, 2}, {7, 3}}) set.at(x, y) = 1;
  const auto all = components(set, 0);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(count(all[0]), 4U);
  EXPECT_EQ(all[1].at(0, 0), 1);
  EXPECT_EQ(components(set, 0.5).size(), 1U);
}

TEST(Raster, APictureLiesOnTheFloorAsItIsSeen) {
  const PictureFloor floor{{-10, 20}, 0.5};
  EXPECT_EQ(floor.to_floor({0, 0}), (Point{-10, 20}));
  EXPECT_EQ(floor.to_floor({2, 4}), (Point{-9, 18}));
  EXPECT_EQ(floor.to_pixel(floor.to_floor({3, 7})), (Point{3, 7}));
}

}  // namespace
}  // namespace footlight::planner
