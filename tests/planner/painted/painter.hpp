// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/grid.hpp"
#include "core/look.hpp"
#include "planner/painted/marks.hpp"

namespace footlight::planner::test {

/// A painting that is made in a test: white at first. Points in pixels, y down.
class Painter {
 public:
  Painter(int width, int height)
      : width_(width),
        height_(height),
        rgb_(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 255) {}

  [[nodiscard]] RgbPicture picture() const { return {width_, height_, rgb_}; }
  [[nodiscard]] const std::vector<std::uint8_t>& rgb() const { return rgb_; }

  void set(int x, int y, Colour colour) {
    if (x < 0 || y < 0 || x >= width_ || y >= height_) return;
    const std::size_t i = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + std::size_t(x));
    rgb_[i] = colour.red;
    rgb_[i + 1] = colour.green;
    rgb_[i + 2] = colour.blue;
  }
  void box(int x0, int y0, int x1, int y1, Colour colour) {
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) set(x, y, colour);
    }
  }
  void disc(Point middle, double radius, Colour colour) {
    for (int y = int(middle.y - radius); y <= int(middle.y + radius); ++y) {
      for (int x = int(middle.x - radius); x <= int(middle.x + radius); ++x) {
        if (distance(middle, {x + 0.5, y + 0.5}) <= radius) set(x, y, colour);
      }
    }
  }
  /// A round brush along a line; each pixel has the shade of the line's point nearest to it: 0 at the tail, 1 at the
  /// head, between two colours.
  void stroke(const std::vector<Point>& line, double half_width, Colour tail, Colour head) {
    std::vector<double> at(line.size(), 0);
    for (std::size_t i = 1; i < line.size(); ++i) at[i] = at[i - 1] + distance(line[i - 1], line[i]);
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        double least = half_width;
        double shade = -1;
        for (std::size_t i = 1; i < line.size(); ++i) {
          const Point along = line[i] - line[i - 1];
          const Point p{x + 0.5, y + 0.5};
          const double share = std::clamp(dot(p - line[i - 1], along) / squared_length(along), 0.0, 1.0);
          const double away = distance(p, line[i - 1] + share * along);
          if (away > least) continue;
          least = away;
          shade = (at[i - 1] + share * (at[i] - at[i - 1])) / at.back();
        }
        if (shade >= 0) set(x, y, mixed(tail, head, shade));
      }
    }
  }
  static Colour mixed(Colour a, Colour b, double share) {
    const auto one = [&](int from, int to) {
      return static_cast<std::uint8_t>(std::lround(from + share * (to - from)));
    };
    return {one(a.red, b.red), one(a.green, b.green), one(a.blue, b.blue)};
  }

 private:
  int width_;
  int height_;
  std::vector<std::uint8_t> rgb_;
};

}  // namespace footlight::planner::test
