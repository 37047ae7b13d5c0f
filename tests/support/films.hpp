// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "core/film.hpp"

namespace footlight::tests {

/// A mask of the pixels for which `inside(x, y)` holds.
inline Mask mask_where(int width, int height, const std::function<bool(int, int)>& inside) {
  Mask mask(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (inside(x, y)) mask.set(x, y);
    }
  }
  return mask;
}

inline Mask disc(int width, int height, double x0, double y0, double radius) {
  return mask_where(width, height, [=](int x, int y) {
    const double dx = x + 0.5 - x0;
    const double dy = y + 0.5 - y0;
    return dx * dx + dy * dy < radius * radius;
  });
}

/// A film of `frames` masks made by `draw(frame)`, 25 frames a second.
inline Film film_of(int frames, const std::function<Mask(int)>& draw) {
  Film film;
  film.fps = 25;
  for (int f = 0; f < frames; ++f) film.frames.push_back(draw(f));
  film.width = film.frames.front().width();
  film.height = film.frames.front().height();
  return film;
}

}  // namespace footlight::tests
