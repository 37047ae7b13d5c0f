// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/grid.hpp"

namespace footlight::planner {

/// A value for each pixel; row 0 is the top. Points in pixels: x to the right, y down, pixel (x, y) has its middle at
/// (x + 1/2, y + 1/2).
template <class T>
struct Raster {
  int width = 0;
  int height = 0;
  std::vector<T> cells;

  Raster() = default;
  Raster(int w, int h, T value = {})
      : width(w), height(h), cells(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), value) {}

  [[nodiscard]] bool inside(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
  [[nodiscard]] T& at(int x, int y) { return cells[index(x, y)]; }
  [[nodiscard]] const T& at(int x, int y) const { return cells[index(x, y)]; }
  /// The nearest pixel's value beyond the edges.
  [[nodiscard]] const T& clamped(int x, int y) const {
    return at(x < 0 ? 0 : (x >= width ? width - 1 : x), y < 0 ? 0 : (y >= height ? height - 1 : y));
  }
  [[nodiscard]] bool contains(Point pixel) const {
    return pixel.x >= 0 && pixel.y >= 0 && pixel.x < width && pixel.y < height;
  }
  friend bool operator==(const Raster&, const Raster&) = default;
};

/// One flag a pixel.
using PixelSet = Raster<std::uint8_t>;

/// Value between the middles of four pixels; beyond the edges the nearest pixel's.
template <class T>
[[nodiscard]] T bilinear(const Raster<T>& raster, Point pixel) {
  const double x = std::clamp(pixel.x - 0.5, 0.0, raster.width - 1.0);
  const double y = std::clamp(pixel.y - 0.5, 0.0, raster.height - 1.0);
  const int left = static_cast<int>(x);
  const int top = static_cast<int>(y);
  const double u = x - left;
  const double v = y - top;
  return (1 - v) * ((1 - u) * raster.clamped(left, top) + u * raster.clamped(left + 1, top)) +
         v * ((1 - u) * raster.clamped(left, top + 1) + u * raster.clamped(left + 1, top + 1));
}

/// For each pixel the nearest pixel of a set: its index, and the distance between the middles.
struct NearestPixels {
  Raster<std::int32_t> pixel;  ///< -1 where the set is empty
  Raster<double> distance_px;  ///< infinite where the set is empty
};

/// Exact Euclidean distance transform with its feature.
///
/// Source: Felzenszwalb, Huttenlocher, "Distance Transforms of Sampled Functions", Theory of Computing 8, 2012, section
/// 2: lower envelope of parabolas, columns then rows. O(pixels)
[[nodiscard]] NearestPixels nearest_pixels(const PixelSet& set);

/// Pixels that hang together (8 neighbours): those with at least `least_share` of the largest one's pixels, up to 64 of
/// them, largest first, among equals the one met first row by row. O(pixels x result)
[[nodiscard]] std::vector<PixelSet> components(const PixelSet& set, double least_share);

[[nodiscard]] std::size_t count(const PixelSet& set);

/// Where a picture lies on the floor: square pixels, one size, upright.
struct PictureFloor {
  Point corner;        ///< of the picture, top left, metres
  double pixel_m = 1;  ///< side of a pixel

  [[nodiscard]] Point to_floor(Point pixel) const {
    return {corner.x + pixel.x * pixel_m, corner.y - pixel.y * pixel_m};
  }
  [[nodiscard]] Point to_pixel(Point floor) const {
    return {(floor.x - corner.x) / pixel_m, (corner.y - floor.y) / pixel_m};
  }
  /// The same picture with pixels `times` as large.
  [[nodiscard]] PictureFloor coarser(double times) const { return {corner, pixel_m * times}; }
};

}  // namespace footlight::planner
