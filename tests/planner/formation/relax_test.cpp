// SPDX-License-Identifier: Apache-2.0
#include "planner/formation/relax.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "planner/formation/spread.hpp"
#include "tests/support/films.hpp"

namespace footlight::planner {
namespace {

bool in_picture(const Mask& mask, Point p) {
  return p.x >= 0 && p.y >= 0 && p.x < mask.width() && p.y < mask.height() &&
         mask.at(static_cast<int>(p.x), static_cast<int>(p.y));
}

TEST(FillPicture, GivesExactlyAsManyPointsInsideOfIt) {
  EXPECT_TRUE(rc::check([] {
    const int width = *rc::gen::inRange(1, 90);
    const int height = *rc::gen::inRange(1, 90);
    const int one_of = *rc::gen::inRange(1, 6);
    const auto seed = *rc::gen::arbitrary<std::uint64_t>();
    const Mask mask = tests::mask_where(
        width, height, [&](int x, int y) { return (x == 0 && y == 0) || (x * 7 + y * 13 + x * y) % one_of == 0; });
    const int people = *rc::gen::inRange(1, 400);
    const auto points = fill_picture(mask, people, seed);
    RC_ASSERT(points.size() == static_cast<std::size_t>(people));
    for (const Point p : points) RC_ASSERT(in_picture(mask, p));
    RC_ASSERT(points == fill_picture(mask, people, seed));
  }));
}

TEST(FillPicture, IsEvenOverAllOfThePicture) {
  const Mask mask = tests::mask_where(400, 200, [](int x, int y) { return y < 100 || x < 200; });
  const auto points = fill_picture(mask, 300, 1);  // 200 squares of 20 x 20 would be 150 people a half
  int upper = 0;
  for (const Point p : points) upper += p.y < 100 ? 1 : 0;
  EXPECT_NEAR(upper, 200, 8);  // two thirds of the area
}

TEST(FillPicture, KeepsNeighboursApartAsChanceDoesNot) {
  const Mask mask = tests::disc(300, 300, 150, 150, 140);
  const auto points = fill_picture(mask, 500, 9);
  const double even = std::sqrt(3.14159 * 140 * 140 / 500);
  EXPECT_GT(least_distance(points), 0.8 * even);
}

TEST(FillPicture, OtherSeedsGiveOtherPointsWhereTheNumberIsMadeExact) {
  const Mask mask = tests::disc(300, 300, 150, 150, 100);
  EXPECT_NE(fill_picture(mask, 333, 1), fill_picture(mask, 333, 2));
}

}  // namespace
}  // namespace footlight::planner
