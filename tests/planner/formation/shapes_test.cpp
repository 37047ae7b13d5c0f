// SPDX-License-Identifier: Apache-2.0
#include "planner/formation/shapes.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "planner/formation/spread.hpp"

namespace footlight::planner {
namespace {

using Kind = Shape::Kind;
constexpr double kPi = std::numbers::pi;

Shape shape(Kind kind) {
  Shape out;
  out.kind = kind;
  return out;
}

Part sized(double width_m, double height_m = 0) {
  Part out;
  out.width_m = width_m;
  out.height_m = height_m;
  return out;
}

Part round(double radius_m) {
  Part out;
  out.radius_m = radius_m;
  return out;
}

void expect_near(Point is, Point wanted) {
  EXPECT_NEAR(is.x, wanted.x, 1e-9);
  EXPECT_NEAR(is.y, wanted.y, 1e-9);
}

TEST(Shapes, ALineGoesFromStageRightToStageLeft) {
  const Laid laid = lay_shape(shape(Kind::line), sized(8), 5, 1);
  for (int k = 0; k < 5; ++k) expect_near(laid.points[static_cast<std::size_t>(k)], {2.0 * k - 4, 0});
  EXPECT_DOUBLE_EQ(laid.apart_m, 2);
}

TEST(Shapes, ABlockHasFilesAndRanksAndItsLastRankInTheMiddle) {
  Shape block = shape(Kind::block);
  block.rows = 3;
  const Laid laid = lay_shape(block, Part{}, 11, 2);
  ASSERT_EQ(laid.points.size(), 11U);
  expect_near(laid.points[0], {-3, -2});
  expect_near(laid.points[3], {3, -2});
  expect_near(laid.points[7], {3, 0});
  expect_near(laid.points[8], {-2, 2});
  expect_near(laid.points[10], {2, 2});
}

TEST(Shapes, ABlockWithASizeHasTheRanksThatFitIt) {
  const Laid laid = lay_shape(shape(Kind::block), sized(9, 3), 40, 1);
  expect_near(laid.points.front(), {-4.5, -1.5});
  expect_near(laid.points.back(), {4.5, 1.5});
  EXPECT_NEAR(laid.apart_m, 1, 1e-9);
}

TEST(Shapes, ARingHasOneSpaceBetweenAllNeighboursAndBeginsUpstage) {
  const Laid laid = lay_shape(shape(Kind::ring), round(5), 12, 1);
  expect_near(laid.points[0], {0, 5});
  expect_near(laid.points[3], {-5, 0});
  EXPECT_NEAR(laid.apart_m, 10 * std::sin(kPi / 12), 1e-9);
}

TEST(Shapes, AnArcEndsAtItsAngleAndItsMiddleIsUpstage) {
  Shape arc = shape(Kind::arc);
  arc.angle_rad = kPi / 2;
  const Laid laid = lay_shape(arc, round(2), 3, 1);
  expect_near(laid.points[0], {-std::numbers::sqrt2, std::numbers::sqrt2});
  expect_near(laid.points[1], {0, 2});
  expect_near(laid.points[2], {std::numbers::sqrt2, std::numbers::sqrt2});
}

TEST(Shapes, ASpiralIsEvenAlongItsLengthFromTheMiddleToItsRadius) {
  const Laid laid = lay_shape(shape(Kind::spiral), round(10), 200, 1);
  expect_near(laid.points.front(), {0, 0});
  EXPECT_NEAR(length(laid.points.back()), 10, 1e-9);
  // 200 chords of a spiral of two turns: r = 10 a / (4 pi), its length from 0 to 4 pi in closed form.
  const double last = 4 * kPi;
  const double whole = 10 / last * (last * std::sqrt(1 + last * last) + std::asinh(last)) / 2;
  for (std::size_t k = 1; k < 200; ++k) {
    EXPECT_NEAR(distance(laid.points[k], laid.points[k - 1]), whole / 199, 0.012) << k;
  }
}

TEST(Shapes, AWedgeHasItsPointDownstageAndRanksOfOneMoreEach) {
  const Laid laid = lay_shape(shape(Kind::wedge), Part{}, 6, 2);
  const double rank = std::numbers::sqrt3;
  expect_near(laid.points[0], {0, -rank});
  expect_near(laid.points[1], {-1, 0});
  expect_near(laid.points[2], {1, 0});
  expect_near(laid.points[5], {2, rank});
  EXPECT_NEAR(laid.apart_m, 2, 1e-9);
}

TEST(Shapes, AChevronHasTwoLinesThatMeetDownstage) {
  const Laid laid = lay_shape(shape(Kind::chevron), sized(8, 6), 5, 1);
  expect_near(laid.points[0], {-4, 3});
  expect_near(laid.points[1], {-2, 0});
  expect_near(laid.points[2], {0, -3});
  expect_near(laid.points[4], {4, 3});
}

TEST(Shapes, ACircleIsFilledEvenly) {
  const Laid laid = lay_shape(shape(Kind::circle), round(10), 400, 1);
  int inner = 0;
  for (const Point p : laid.points) {
    EXPECT_LE(length(p), 10);
    inner += length(p) < 5 ? 1 : 0;
  }
  EXPECT_EQ(inner, 100);  // a quarter of the area
  EXPECT_GT(least_distance(laid.points), 0.75);
}

TEST(Shapes, OfNoSizeHaveTheirNeighboursAsFarApartAsTheSpacing) {
  EXPECT_TRUE(rc::check([] {
    const Shape one = shape(static_cast<Kind>(*rc::gen::inRange(0, 8)));
    const int people = *rc::gen::inRange(2, 300);
    const double spacing_m = 0.1 * *rc::gen::inRange(1, 60);
    const Laid laid = lay_shape(one, Part{}, people, spacing_m);
    RC_ASSERT(laid.points.size() == static_cast<std::size_t>(people));
    RC_ASSERT(std::abs(least_distance(laid.points) - spacing_m) < 1e-9 * people);
  }));
}

TEST(Shapes, OfOnePersonAreHerPlace) {
  for (int kind = 0; kind < 8; ++kind) {
    EXPECT_EQ(lay_shape(shape(static_cast<Kind>(kind)), Part{}, 1, 1).points.size(), 1U) << kind;
    EXPECT_EQ(lay_shape(shape(static_cast<Kind>(kind)), sized(3, 3), 1, 1).points.size(), 1U) << kind;
  }
}

}  // namespace
}  // namespace footlight::planner
