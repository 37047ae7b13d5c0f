// SPDX-License-Identifier: Apache-2.0
#include "app/paper/capsules.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace footlight::app {
namespace {

double squared_distance(Point p, const Capsule& capsule) {
  const Point way = capsule.to - capsule.from;
  const double squared = squared_length(way);
  const double share = squared > 0 ? std::clamp(dot(p - capsule.from, way) / squared, 0.0, 1.0) : 0.0;
  return squared_length(p - (capsule.from + share * way));
}

/// Mixes a capsule into pixels of 4 bytes; its edge is as soft as a pixel is wide.
void blend(const Capsule& capsule, unsigned char* pixels, int stride, int width, int height) {
  const double reach = capsule.radius + 0.5;
  const auto from = [&](double a, double b) {
    return std::max(0, static_cast<int>(std::floor(std::min(a, b) - reach)));
  };
  const auto until = [&](double a, double b, int size) {
    return std::min(size, static_cast<int>(std::ceil(std::max(a, b) + reach)));
  };
  const double inner = std::max(0.0, capsule.radius - 0.5);
  const double colour[] = {255 * capsule.colour.blue, 255 * capsule.colour.green, 255 * capsule.colour.red};
  const int right = until(capsule.from.x, capsule.to.x, width);
  const int below = until(capsule.from.y, capsule.to.y, height);
  for (int y = from(capsule.from.y, capsule.to.y); y < below; ++y) {
    for (int x = from(capsule.from.x, capsule.to.x); x < right; ++x) {
      const double squared = squared_distance({x + 0.5, y + 0.5}, capsule);
      if (squared >= reach * reach) continue;
      const double cover = squared <= inner * inner ? 1.0 : std::min(1.0, reach - std::sqrt(squared));
      unsigned char* pixel = pixels + static_cast<std::ptrdiff_t>(y) * stride + 4 * static_cast<std::ptrdiff_t>(x);
      const double share = cover * capsule.colour.alpha;
      for (int c = 0; c < 3; ++c)
        pixel[c] = static_cast<unsigned char>(pixel[c] + share * (colour[c] - pixel[c]) + 0.5);
    }
  }
}

}  // namespace

void blend_capsules(std::span<const Capsule> list, std::span<unsigned char> pixels, int stride, int width, int height) {
  for (const Capsule& one : list) blend(one, pixels.data(), stride, width, height);
}

}  // namespace footlight::app
