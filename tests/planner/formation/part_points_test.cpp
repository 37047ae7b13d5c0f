// SPDX-License-Identifier: Apache-2.0
#include "planner/formation/part_points.hpp"

#include <algorithm>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planner/formation/spread.hpp"
#include "planner/plan_section.hpp"
#include "tests/planner/small_show.hpp"

namespace footlight::planner {
namespace {

class PartPointsTest : public testing::Test {
 protected:
  PartPointsTest() : usable_(static_cast<std::size_t>(stage_.grid.size()), 1) {}

  Result<PartPoints, PartError> points(const Part& part, int people, const Mask* picture = nullptr) {
    return part_points({&stage_, &part, picture, &usable_, people, 1.0, 1});
  }
  static Part mesh(std::vector<std::array<double, 3>> vertices, Mesh::View view = Mesh::View::top) {
    Part out;
    out.drawing = Mesh{"/shows/bird.obj", view, std::move(vertices)};
    return out;
  }
  static Part picture(ColourRange colours = {}) {
    Part out;
    PictureOptions options;
    options.colour = colours;
    out.drawing = Picture{"/shows/dove.png", options};
    return out;
  }

  Stage stage_ = test::show_with(1).stage;
  CellFlags usable_;
};

TEST_F(PartPointsTest, AMeshIsSeenFromItsSides) {
  const Mesh top{"", Mesh::View::top, {{1, 2, 3}}};
  EXPECT_EQ(projected(top), (std::vector<Point>{{1, -3}}));
  EXPECT_EQ(projected({"", Mesh::View::front, {{1, 2, 3}}}), (std::vector<Point>{{1, 2}}));
  EXPECT_EQ(projected({"", Mesh::View::side, {{1, 2, 3}}}), (std::vector<Point>{{-3, 2}}));
}

TEST_F(PartPointsTest, CornersOfAMeshAreLaidInItsSizeAndThinned) {
  std::vector<std::array<double, 3>> vertices;
  for (int x = 0; x <= 40; ++x) {
    for (int z = 0; z <= 20; ++z) vertices.push_back({0.1 * x, 7.0, 0.1 * z});
  }
  Part part = mesh(vertices);
  part.width_m = 16;
  part.at = Point{1, 9};
  const auto made = points(part, 40);
  ASSERT_TRUE(made) << made.error().message;
  ASSERT_EQ(made->points.size(), 40U);
  EXPECT_GT(least_distance(made->points), 1.0);
  for (const Point p : made->points) {
    EXPECT_TRUE(p.x >= -7 - 1e-9 && p.x <= 9 + 1e-9 && p.y >= 5 - 1e-9 && p.y <= 13 + 1e-9) << p.x << ' ' << p.y;
  }
}

TEST_F(PartPointsTest, CornersWithoutASizeAreAsFarApartAsTheSpacing) {
  Part part = mesh({{0, 0, 0}, {5, 1, 0}, {0, 3, 5}, {5, 0, 5}, {0, 9, 0}});
  part.spacing_m = 3;
  const auto made = points(part, 4);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_NEAR(least_distance(made->points), 3, 1e-6);
}

TEST_F(PartPointsTest, FewerCornersThanPeopleAreRefused) {
  const auto made = points(mesh({{0, 0, 0}, {5, 1, 0}, {0, 3, 5}, {0, 9, 0}}), 4);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().message, "the mesh 'bird.obj' has 3 different corners as seen from here, and 4 people");
}

TEST_F(PartPointsTest, APictureIsLaidByWhatIsInItNotByItsFrame) {
  const Mask mask = tests::mask_where(200, 100, [](int x, int y) { return x >= 120 && x < 180 && y >= 10 && y < 40; });
  Part part = picture();
  part.width_m = 12;
  part.at = Point{-3, 8};
  const auto made = points(part, 60, &mask);
  ASSERT_TRUE(made);
  ASSERT_EQ(made->points.size(), 60U);
  for (const Point p : made->points) EXPECT_TRUE(p.x >= -9 && p.x <= 3 && p.y >= 5 && p.y <= 11) << p.x << ' ' << p.y;
  EXPECT_EQ(std::count(made->only.begin(), made->only.end(), 1), 72);  // 12 x 6 cells
  EXPECT_EQ(made->apart_m, 1);
}

TEST_F(PartPointsTest, APictureIsTurnedWithItsCells) {
  const Mask mask = tests::mask_where(100, 100, [](int x, int y) { return y >= 40 && y < 60 && x < 100; });
  Part part = picture();
  part.width_m = 10;  // and two metres high
  part.at = Point{0.0, 10.0};
  part.turn_rad = std::numbers::pi / 2;
  const auto made = points(part, 15, &mask);
  ASSERT_TRUE(made);
  for (const Point p : made->points) EXPECT_TRUE(std::abs(p.x) <= 1 && std::abs(p.y - 10) <= 5) << p.x << ' ' << p.y;
  for (std::size_t i = 0; i < made->only.size(); ++i) {
    if (made->only[i] == 0) continue;
    const Point centre = stage_.grid.centre(CellIndex::of(i));
    EXPECT_TRUE(std::abs(centre.x) < 2 && std::abs(centre.y - 10) < 6) << centre.x << ' ' << centre.y;
  }
}

TEST_F(PartPointsTest, APictureOfNoSizeGivesEachPersonASquareOfTheSpacing) {
  const Mask mask = tests::mask_where(100, 50, [](int, int) { return true; });
  Part part = picture();
  part.spacing_m = 2;
  const auto made = points(part, 50, &mask);  // 200 m2
  ASSERT_TRUE(made);
  EXPECT_NEAR(static_cast<double>(std::count(made->only.begin(), made->only.end(), 1)), 20 * 10, 1);
}

TEST_F(PartPointsTest, AnEmptyPictureSaysWhatWasLookedFor) {
  const Mask mask(20, 20);
  const auto made = points(picture({{0x10, 0x10, 0x10}, {0x40, 0x40, 0x40}}), 4, &mask);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().message, "no pixel of 'dove.png' is between #101010 and #404040");
  EXPECT_EQ(made.error().hint, "another threshold or other colours");
}

TEST_F(PartPointsTest, APictureTooSmallForItsPeopleIsNoMoreThanItsCells) {
  const Mask mask = tests::mask_where(10, 10, [](int, int) { return true; });
  Part part = picture();
  part.width_m = 4;
  part.at = Point{0, 10};
  const auto made = points(part, 64, &mask);
  ASSERT_TRUE(made);
  EXPECT_NEAR(made->apart_m, 0.5, 1e-9);  // 16 cells
}

}  // namespace
}  // namespace footlight::planner
