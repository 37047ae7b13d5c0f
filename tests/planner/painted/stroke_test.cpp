// SPDX-License-Identifier: Apache-2.0
#include "planner/painted/stroke.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "planner/painted/flow_field.hpp"
#include "tests/planner/painted/painter.hpp"

namespace footlight::planner {
namespace {

constexpr Colour kBright{255, 170, 170};
constexpr Colour kDark{110, 20, 20};

struct Painted {
  PixelSet pixels;
  Raster<float> brightness;
};

Painted read(const RgbPicture& picture) {
  Painted out{PixelSet(picture.width, picture.height), Raster<float>(picture.width, picture.height)};
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const Colour c = picture.at(x, y);
      out.pixels.at(x, y) = c == Colour{255, 255, 255} ? 0 : 1;
      out.brightness.at(x, y) = brightness(c);
    }
  }
  return out;
}

StrokeResult stroke_along(const std::vector<Point>& line, double half_width, Colour tail = kBright,
                          Colour head = kDark) {
  test::Painter painter(160, 120);
  painter.stroke(line, half_width, tail, head);
  const Painted painted = read(painter.picture());
  return read_stroke(painted.pixels, painted.brightness);
}

double angle(Point a, Point b) {
  return std::abs(std::atan2(a.x * b.y - a.y * b.x, dot(a, b))) * 180 / std::numbers::pi;
}

/// Share of the painted pixels in which the field is within 20 degrees of the painter's line there.
double right_share(const std::vector<Point>& line, double half_width) {
  const auto read = stroke_along(line, half_width);
  if (!read.stroke) return 0;
  const FlowField field = flow_field(*read.stroke, 160, 120);
  double right = 0;
  double all = 0;
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 160; ++x) {
      if (read.stroke->pixels.at(x, y) == 0) continue;
      const Point p{x + 0.5, y + 0.5};
      double least = INFINITY;
      Point along;
      for (std::size_t i = 1; i < line.size(); ++i) {
        const Point step = line[i] - line[i - 1];
        const double share = std::clamp(dot(p - line[i - 1], step) / squared_length(step), 0.0, 1.0);
        const double away = squared_length(p - (line[i - 1] + share * step));
        if (away < least) {
          least = away;
          along = step;
        }
      }
      all += 1;
      right += angle(field.direction.at(x, y), along) <= 20 ? 1 : 0;
    }
  }
  return right / all;
}

TEST(Stroke, PeopleComeFromWhereItIsBright) {
  const auto east = stroke_along({{20, 60}, {140, 60}}, 8);
  ASSERT_TRUE(east.stroke);
  EXPECT_LT(east.stroke->line.front().x, 20);
  EXPECT_GT(east.stroke->line.back().x, 140);
  const auto west = stroke_along({{140, 60}, {20, 60}}, 8);
  ASSERT_TRUE(west.stroke);
  EXPECT_GT(west.stroke->line.front().x, west.stroke->line.back().x);
  EXPECT_GT(west.stroke->skeleton.front().x, west.stroke->skeleton.back().x);
}

TEST(Stroke, ItsMiddleLineAndWidthAreThoseOfThePaint) {
  const auto read = stroke_along({{20, 60}, {140, 60}}, 8);
  ASSERT_TRUE(read.stroke);
  for (std::size_t i = 0; i < read.stroke->line.size(); ++i) {
    const Point p = read.stroke->line[i];
    EXPECT_NEAR(p.y, 60, 1.5);
    if (p.x > 30 && p.x < 130) {
      EXPECT_NEAR(read.stroke->half_width[i], 8, 1.0) << p.x;
    }
  }
  EXPECT_NEAR(read.stroke->length_px(), 136, 5);
  EXPECT_NEAR(read.stroke->fall, brightness(kBright) - brightness(kDark), 15);
}

TEST(Stroke, OfOneShadeItHasNoSense) {
  const auto read = stroke_along({{20, 60}, {140, 60}}, 8, kDark, kDark);
  ASSERT_FALSE(read.stroke);
  EXPECT_EQ(read.why_not, NoStroke::no_gradient);
  EXPECT_EQ(read_stroke(PixelSet(9, 9), Raster<float>(9, 9)).why_not, NoStroke::empty);
}

TEST(Stroke, ABlotWithoutLengthHasNoSense) {
  PixelSet dot(9, 9);
  dot.at(4, 4) = 1;
  EXPECT_FALSE(read_stroke(dot, Raster<float>(9, 9)).stroke);
}

TEST(Stroke, DirectionsOfKnownLinesAreRightInNearlyAllOfTheirPixels) {
  std::vector<Point> arc;
  std::vector<Point> wave;
  for (int i = 0; i <= 40; ++i) {
    const double t = i / 40.0;
    arc.push_back({80 - 50 * std::cos(std::numbers::pi * t), 95 - 70 * std::sin(std::numbers::pi * t)});
    wave.push_back({15 + 130 * t, 60 + 30 * std::sin(2 * std::numbers::pi * t)});
  }
  const std::vector<std::pair<const char*, double>> shares{
      {"straight", right_share({{20, 30}, {140, 90}}, 9)},
      {"arc", right_share(arc, 7)},
      {"wave", right_share(wave, 6)},
      {"corner", right_share({{20, 20}, {120, 20}, {120, 100}}, 6)},
  };
  for (const auto& [name, share] : shares) {
    RecordProperty(name, std::to_string(share));
    EXPECT_GT(share, 0.9) << name;
  }
}

TEST(Stroke, BristlesAndForksDoNotTurnIt) {
  test::Painter painter(160, 120);
  painter.stroke({{20, 60}, {140, 60}}, 8, kBright, kDark);
  painter.stroke({{60, 60}, {66, 40}}, 2, {200, 100, 100}, {199, 99, 99});
  painter.box(80, 58, 84, 60, {255, 255, 255});
  const Painted painted = read(painter.picture());
  const auto read = read_stroke(painted.pixels, painted.brightness);
  ASSERT_TRUE(read.stroke);
  for (std::size_t i = 1; i < read.stroke->line.size(); ++i) {
    EXPECT_LT(angle(read.stroke->line[i] - read.stroke->line[i - 1], {1, 0}), 30);
  }
}

TEST(FlowField, IsTheSumOfStepsWeightedByTheirDistance) {
  Stroke stroke;
  stroke.line = {{10, 10}, {12, 10}, {12, 13}};
  stroke.half_width = {2, 4, 4};
  double strength = 0;
  const Point v = stroke_velocity(stroke, {10, 12}, strength);
  // |G - r0| = 2, h 2: e^-1; |G - r1| = sqrt 8, h 4: e^-1/2. The last point has no step.
  EXPECT_NEAR(v.x, 2 * std::exp(-1.0), 1e-12);
  EXPECT_NEAR(v.y, 3 * std::exp(-0.5), 1e-12);
  EXPECT_NEAR(strength, std::exp(-0.5), 1e-12);
  EXPECT_EQ(radial_basis(5.01, 2), 0);
}

TEST(FlowField, ItsDirectionIsThatOfTheSumAndItsLengthOneWhateverTheSampling) {
  Stroke stroke;
  stroke.line = {{10, 10}, {12, 10}, {12, 13}};
  stroke.half_width = {2, 4, 4};
  const FlowField field = flow_field(stroke, 30, 30);
  double strength = 0;
  const Point printed = stroke_velocity(stroke, {10.5, 12.5}, strength);
  EXPECT_NEAR(field.direction.at(10, 12).x, printed.x / length(printed), 1e-12);
  EXPECT_NEAR(field.strength.at(10, 12), strength, 1e-12);
  EXPECT_EQ(field.direction.at(29, 29), (Point{}));
  EXPECT_EQ(field.strength.at(29, 29), 0);
}

}  // namespace
}  // namespace footlight::planner
