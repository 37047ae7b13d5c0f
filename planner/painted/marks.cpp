// SPDX-License-Identifier: Apache-2.0
#include "planner/painted/marks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>

namespace footlight::planner {
namespace {

constexpr int kWhite = 230;
constexpr int kSoftEdge = 2;  // pixels
constexpr double kBackgroundShare = 1.0 / 3;

int spread(Colour c) { return std::max({c.red, c.green, c.blue}) - std::min({c.red, c.green, c.blue}); }

/// Angle in the plane across the grey diagonal, radians: what black or white does not change when mixed in.
double hue(Colour c) {
  const double r = c.red;
  const double g = c.green;
  const double b = c.blue;
  return std::atan2(std::numbers::sqrt3 * (g - b), 2 * r - g - b);
}

/// How far a colour is from a paint's, 1 at its tolerance.
double misfit(Colour colour, const Paint& paint) {
  const double tolerance = std::max(paint.tolerance, 0.5);
  if (paint.role == Paint::Role::shape) {
    const int most = std::max({std::abs(colour.red - paint.colour.red), std::abs(colour.green - paint.colour.green),
                               std::abs(colour.blue - paint.colour.blue)});
    return most / tolerance;
  }
  const double turn = std::abs(std::remainder(hue(colour) - hue(paint.colour), 2 * std::numbers::pi));
  return turn * 180 / std::numbers::pi / tolerance;
}

std::int16_t mark_of(Colour colour, const PaintedOptions& options) {
  std::int16_t best = kUnknownMark;
  double least = 1;
  // A shape's own colour counts before a stroke of its hue.
  for (const Paint::Role role : {Paint::Role::shape, Paint::Role::stroke}) {
    for (std::size_t i = 0; i < options.paint.size(); ++i) {
      if (options.paint[i].role != role) continue;
      const bool grey = spread(colour) <= options.grey_tolerance;
      if (grey && role == Paint::Role::stroke) continue;
      const double away = misfit(colour, options.paint[i]);
      if (away > least || (away == least && best != kUnknownMark)) continue;
      least = away;
      best = static_cast<std::int16_t>(i);
    }
    if (best != kUnknownMark) return best;
  }
  if (std::min({colour.red, colour.green, colour.blue}) >= kWhite) return kFloorMark;
  return spread(colour) <= options.grey_tolerance ? kBackgroundMark : kUnknownMark;
}

bool near_mark(const Raster<std::int16_t>& marks, int x, int y) {
  for (int dy = -kSoftEdge; dy <= kSoftEdge; ++dy) {
    for (int dx = -kSoftEdge; dx <= kSoftEdge; ++dx) {
      if (!marks.inside(x + dx, y + dy)) continue;
      const std::int16_t mark = marks.at(x + dx, y + dy);
      if (mark >= 0 || mark == kBackgroundMark) return true;
    }
  }
  return false;
}

}  // namespace

float brightness(Colour colour) {
  return 0.299F * static_cast<float>(colour.red) + 0.587F * static_cast<float>(colour.green) +
         0.114F * static_cast<float>(colour.blue);
}

Raster<std::int16_t> read_marks(const RgbPicture& picture, const PaintedOptions& options) {
  Raster<std::int16_t> marks(picture.width, picture.height, kFloorMark);
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) marks.at(x, y) = mark_of(picture.at(x, y), options);
  }
  std::vector<std::size_t> soft;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      if (marks.at(x, y) == kUnknownMark && near_mark(marks, x, y)) soft.push_back(marks.index(x, y));
    }
  }
  for (const std::size_t at : soft) marks.cells[at] = kFloorMark;
  return marks;
}

std::vector<UnknownColour> unknown_colours(const RgbPicture& picture, const Raster<std::int16_t>& marks) {
  struct Sum {
    std::size_t pixels = 0;
    std::array<std::size_t, 3> colour{};
  };
  std::map<std::array<int, 3>, Sum> alike;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      if (marks.at(x, y) != kUnknownMark) continue;
      const Colour c = picture.at(x, y);
      Sum& sum = alike[{c.red / 32, c.green / 32, c.blue / 32}];
      ++sum.pixels;
      sum.colour[0] += c.red;
      sum.colour[1] += c.green;
      sum.colour[2] += c.blue;
    }
  }
  std::vector<UnknownColour> out;
  for (const auto& [key, sum] : alike) {
    const auto mean = [&](std::size_t i) { return static_cast<std::uint8_t>(sum.colour.at(i) / sum.pixels); };
    out.push_back({{mean(0), mean(1), mean(2)}, sum.pixels});
  }
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.pixels > b.pixels; });
  return out;
}

FloorMarks marks_on_floor(const RgbPicture& picture, const Raster<std::int16_t>& marks,
                          const PictureFloor& picture_floor, const PictureFloor& floor, int width, int height) {
  FloorMarks out{Raster<std::int16_t>(width, height, kFloorMark), Raster<float>(width, height, 255)};
  const double ratio = floor.pixel_m / picture_floor.pixel_m;
  const int looks = std::clamp(static_cast<int>(std::ceil(ratio)), 1, 64);
  std::map<std::int16_t, std::pair<int, float>> seen;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      seen.clear();
      for (int k = 0; k < looks * looks; ++k) {
        const Point at{x + (k % looks + 0.5) / looks, y + (k / looks + 0.5) / looks};
        const Point from = picture_floor.to_pixel(floor.to_floor(at));
        if (!marks.contains(from)) continue;
        const int px = static_cast<int>(from.x);
        const int py = static_cast<int>(from.y);
        auto& [many, sum] = seen[marks.at(px, py)];
        ++many;
        sum += brightness(picture.at(px, py));
      }
      int most = 0;
      for (const auto& [mark, what] : seen) {
        const bool wall = mark == kBackgroundMark && what.first >= kBackgroundShare * looks * looks;
        if (!wall && what.first <= most) continue;
        most = wall ? looks * looks : what.first;
        out.marks.at(x, y) = mark;
        out.brightness.at(x, y) = what.second / static_cast<float>(what.first);
      }
    }
  }
  return out;
}

PixelSet pixels_of(const Raster<std::int16_t>& marks, std::int16_t mark) {
  PixelSet out(marks.width, marks.height);
  for (std::size_t i = 0; i < marks.cells.size(); ++i) out.cells[i] = marks.cells[i] == mark ? 1 : 0;
  return out;
}

}  // namespace footlight::planner
