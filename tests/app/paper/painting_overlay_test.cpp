// SPDX-License-Identifier: Apache-2.0
#include "app/paper/painting_overlay.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

#include <cairo.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/check.hpp"
#include "tests/planner/painted/painted_show.hpp"

namespace footlight::app {
namespace {

using planner::test::kGrey;
using planner::test::PaintedShow;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr double kSide_m = 1;

planner::PaintedScene understood(const PaintedShow& one) {
  auto scene = one.read();
  EXPECT_TRUE(scene) << scene.error().message;
  return std::move(*scene);
}

/// Red, green, blue of a pixel, and how many pixels of a PNG have about it.
using Rgb = std::array<int, 3>;
constexpr Rgb kStroke{213, 94, 0};
constexpr Rgb kField{0, 114, 178};
constexpr Rgb kShape{0, 158, 115};
constexpr Rgb kWallField{204, 121, 167};

int pixels_like(std::string_view png, Rgb colour) {
  const auto read = [](void* left, unsigned char* data, unsigned size) {
    auto& bytes = *static_cast<std::string_view*>(left);
    if (bytes.size() < size) return CAIRO_STATUS_READ_ERROR;
    std::memcpy(data, bytes.data(), size);
    bytes.remove_prefix(size);
    return CAIRO_STATUS_SUCCESS;
  };
  cairo_surface_t* surface = cairo_image_surface_create_from_png_stream(read, &png);
  FL_CHECK(cairo_surface_status(surface) == CAIRO_STATUS_SUCCESS);
  int out = 0;
  for (int y = 0; y < cairo_image_surface_get_height(surface); ++y) {
    const unsigned char* row = cairo_image_surface_get_data(surface) + y * cairo_image_surface_get_stride(surface);
    for (int x = 0; x < cairo_image_surface_get_width(surface); ++x) {
      const unsigned char* p = row + 4 * x;
      out += std::abs(p[2] - colour[0]) + std::abs(p[1] - colour[1]) + std::abs(p[0] - colour[2]) < 8 ? 1 : 0;
    }
  }
  cairo_surface_destroy(surface);
  return out;
}

std::string drawn(const PaintedShow& one, bool svg) {
  const planner::PaintedScene scene = understood(one);
  return painting_overlay({&one.show, SectionIndex(0), &scene, one.painter.picture()}, svg);
}

TEST(FieldArrows, OfAStrokePointFromItsTailToItsHeadWhereTheStrokeIs) {
  const FieldArrows arrows = field_arrows(understood(PaintedShow()), kSide_m);
  // The stroke goes from x = -8.5 to 8.5, half a width of 1.25 m around y = 10: two rows of squares are on it, and none
  // are more than three half widths away.
  EXPECT_GE(arrows.strokes.size(), 2U * 17);
  EXPECT_LE(arrows.strokes.size(), 8U * 26);
  for (const FieldArrow& one : arrows.strokes) {
    EXPECT_LT(std::abs(one.at.y - 10), 3 * 1.25 + 0.5);
    EXPECT_LT(std::abs(std::atan2(one.way.y, one.way.x)), 0.35) << one.at.x << " " << one.at.y;
    EXPECT_GE(length(one.way), 0.15);
    EXPECT_LE(length(one.way), 1 + 1e-9);
  }
  EXPECT_TRUE(arrows.background.empty());
}

TEST(FieldArrows, PointUpstageWhereAStrokeLeadsUpThePicture) {
  PaintedShow one;
  one.painter = planner::test::Painter{120, 80};
  one.painter.box(40, 58, 80, 78, one.options.paint[0].colour);
  one.painter.box(40, 2, 80, 22, one.options.paint[1].colour);
  one.painter.stroke({{60, 56}, {60, 24}}, 5, {255, 150, 150}, {110, 20, 20});
  const FieldArrows arrows = field_arrows(understood(one), kSide_m);
  ASSERT_FALSE(arrows.strokes.empty());
  for (const FieldArrow& arrow : arrows.strokes) EXPECT_GT(arrow.way.y, 0.9 * length(arrow.way));
}

TEST(FieldArrows, AreFewerOnLargerSquaresAndWhereOnlyStrongOnesCount) {
  const planner::PaintedScene scene = understood(PaintedShow());
  const auto fine = field_arrows(scene, kSide_m).strokes.size();
  EXPECT_LT(3 * field_arrows(scene, 2 * kSide_m).strokes.size(), fine);
  EXPECT_LT(field_arrows(scene, kSide_m, 0.6).strokes.size(), fine);
}

TEST(FieldArrows, OfAWallPointAwayFromIt) {
  PaintedShow one;
  one.painter.box(56, 0, 64, 24, kGrey);
  const FieldArrows arrows = field_arrows(understood(one), kSide_m);
  ASSERT_FALSE(arrows.background.empty());
  for (const FieldArrow& arrow : arrows.background) {
    // The wall is 2 m wide, 6 m deep, in the middle upstage.
    const bool beside = arrow.at.y > 15 && std::abs(arrow.at.x) > 1.6;
    if (!beside) continue;
    EXPECT_GT(arrow.way.x * arrow.at.x, 0) << arrow.at.x << " " << arrow.at.y;
  }
}

TEST(PaintingOverlay, TellsGroupsShapesAndStrokes) {
  const PaintedShow one;
  const planner::PaintedScene scene = understood(one);
  EXPECT_EQ(party_name(one.show, scene.parties[0]), "everybody else: 40 people");
  // 20 x 32 pixels of a quarter of a metre: 40 m2.
  const auto lines = party_lines(scene, scene.parties[0]);
  EXPECT_THAT(lines, ElementsAre(StartsWith("shape 1: "), StartsWith("1 to 2: stroke of "), StartsWith("shape 2: ")));
  EXPECT_NEAR(area_m2(scene, scene.parties[0].shapes[0]), 40, 3);
  EXPECT_NEAR(area_m2(scene, scene.parties[0].shapes[1]), 50, 3);
  const planner::Stroke& stroke = scene.parties[0].legs[0].strokes[0];
  EXPECT_NEAR(mean_width_m(scene, stroke), 2.5, 0.5);
  EXPECT_THAT(lines[1], HasSubstr(fmt::format("{:.1f} m wide", mean_width_m(scene, stroke))));
}

TEST(PaintingOverlay, TellsWhereThereIsNoStroke) {
  PaintedShow one;
  one.options.paint.pop_back();
  one.painter = planner::test::Painter{120, 80};
  one.painter.box(2, 24, 22, 56, one.options.paint[0].colour);
  one.painter.box(98, 20, 118, 60, one.options.paint[1].colour);
  const planner::PaintedScene scene = understood(one);
  EXPECT_EQ(party_lines(scene, scene.parties[0])[1], "1 to 2: no stroke, the shortest way");
  const std::string png = drawn(one, false);
  EXPECT_EQ(pixels_like(png, kStroke), 0) << "neither on the floor nor among what the marks mean";
  EXPECT_EQ(pixels_like(png, kField), 0);
  EXPECT_GT(pixels_like(png, kShape), 500);
}

TEST(PaintingOverlay, DrawsEveryKindOfMarkThatThereIs) {
  PaintedShow one;
  const std::string open = drawn(one, false);
  EXPECT_GT(pixels_like(open, kStroke), 500);
  EXPECT_GT(pixels_like(open, kField), 200);
  EXPECT_GT(pixels_like(open, kShape), 500);
  EXPECT_EQ(pixels_like(open, kWallField), 0);
  one.painter.box(56, 0, 64, 24, kGrey);
  EXPECT_GT(pixels_like(drawn(one, false), kWallField), 50);
}

TEST(PaintingOverlay, IsTheSameFileTwice) {
  const PaintedShow one;
  const std::string svg = drawn(one, true);
  EXPECT_THAT(svg, StartsWith("<?xml"));
  EXPECT_EQ(svg, drawn(one, true));
  EXPECT_EQ(drawn(one, false), drawn(one, false));
}

TEST(PaintingOverlay, HasRoomForWarningsBesideAWideFloor) {
  PaintedShow one;
  const auto height = [&](const planner::PaintedScene& scene) {
    const std::string png = painting_overlay({&one.show, SectionIndex(0), &scene, one.painter.picture()}, false);
    const auto byte = [&](std::size_t i) { return static_cast<int>(static_cast<unsigned char>(png[i])); };
    return 256 * byte(22) + byte(23);
  };
  planner::PaintedScene scene = understood(one);
  const int without = height(scene);
  scene.notes.assign(60, "a colour that nobody bound to anything");
  EXPECT_GT(height(scene), without + 500);
}

}  // namespace
}  // namespace footlight::app
