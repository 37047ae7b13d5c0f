// SPDX-License-Identifier: Apache-2.0
#include "planner/painted/gradient_vector_flow.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace footlight::planner {
namespace {

constexpr double kMu = 0.2;
constexpr int kMostSteps = 2000;
constexpr double kSteady = 1e-4;

Point gradient(const Raster<double>& f, int x, int y) {
  return {(f.clamped(x + 1, y) - f.clamped(x - 1, y)) / 2, (f.clamped(x, y + 1) - f.clamped(x, y - 1)) / 2};
}

}  // namespace

Raster<double> median_filtered(const Raster<double>& picture) {
  Raster<double> out(picture.width, picture.height);
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      std::array<double, 9> values{};
      std::size_t n = 0;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) values[n++] = picture.clamped(x + dx, y + dy);
      }
      std::nth_element(values.begin(), values.begin() + 4, values.end());
      out.at(x, y) = values[4];
    }
  }
  return out;
}

Raster<double> edge_map(const Raster<double>& picture) {
  Raster<double> out(picture.width, picture.height);
  double most = 0;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      out.at(x, y) = length(gradient(picture, x, y));
      most = std::max(most, out.at(x, y));
    }
  }
  if (most > 0) {
    for (double& value : out.cells) value /= most;
  }
  return out;
}

Raster<Point> gradient_vector_flow(const Raster<double>& edges, double mu, int most_steps) {
  Raster<Point> slope(edges.width, edges.height);
  for (int y = 0; y < edges.height; ++y) {
    for (int x = 0; x < edges.width; ++x) slope.at(x, y) = gradient(edges, x, y);
  }
  Raster<Point> v = slope;
  Raster<Point> next = v;
  // |grad f|^2 is at most 1/2 here: together with diffusion a step stays stable below 1 / (4 mu + 1/2).
  const double step = 1 / (4 * mu + 0.5);
  for (int t = 0; t < most_steps; ++t) {
    double most = 0;
    for (int y = 0; y < edges.height; ++y) {
      for (int x = 0; x < edges.width; ++x) {
        const Point here = v.at(x, y);
        const Point around = v.clamped(x - 1, y) + v.clamped(x + 1, y) + v.clamped(x, y - 1) + v.clamped(x, y + 1);
        const Point f = slope.at(x, y);
        const Point change = step * (mu * (around - 4 * here) - squared_length(f) * (here - f));
        next.at(x, y) = here + change;
        most = std::max({most, std::abs(change.x), std::abs(change.y)});
      }
    }
    std::swap(v, next);
    if (most < kSteady) break;
  }
  return v;
}

Raster<Point> background_field(const PixelSet& background, bool repels, double reach_px) {
  Raster<Point> out(background.width, background.height);
  if (count(background) == 0) return out;
  Raster<double> picture(background.width, background.height);
  for (std::size_t i = 0; i < picture.cells.size(); ++i) picture.cells[i] = background.cells[i] != 0 ? 1 : 0;
  const Raster<double> edges = edge_map(median_filtered(picture));
  out = gradient_vector_flow(edges, kMu, kMostSteps);
  const Raster<double> away = nearest_pixels(background).distance_px;
  for (std::size_t i = 0; i < out.cells.size(); ++i) {
    Point& v = out.cells[i];
    const double size = length(v);
    // Direction of the flow, strength of the distance: the flow's own length falls by orders within a few pixels.
    const double fade = std::max(0.0, 1 - away.cells[i] / reach_px);
    v = size > 1e-9 ? (repels ? -1.0 : 1.0) * fade / size * v : Point{};
  }
  return out;
}

}  // namespace footlight::planner
