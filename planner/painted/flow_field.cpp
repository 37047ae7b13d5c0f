// SPDX-License-Identifier: Apache-2.0
#include "planner/painted/flow_field.hpp"

#include <algorithm>
#include <cmath>

namespace footlight::planner {
namespace {

constexpr double kReach = 2.5;  // half widths; phi is 0.2 % there

}  // namespace

double radial_basis(double away_px, double half_width_px) {
  const double x = away_px / half_width_px;
  return x > kReach ? 0 : std::exp(-x * x);
}

Point stroke_velocity(const Stroke& stroke, Point pixel, double& strength) {
  Point sum;
  strength = 0;
  for (std::size_t i = 0; i + 1 < stroke.line.size(); ++i) {
    const double phi = radial_basis(distance(pixel, stroke.line[i]), stroke.half_width[i]);
    sum = sum + phi * (stroke.line[i + 1] - stroke.line[i]);
    strength = std::max(strength, phi);
  }
  return sum;
}

FlowField flow_field(const Stroke& stroke, int width, int height) {
  FlowField out{Raster<Point>(width, height), Raster<double>(width, height, 0)};
  for (std::size_t i = 0; i + 1 < stroke.line.size(); ++i) {
    const Point r = stroke.line[i];
    const Point step = stroke.line[i + 1] - r;
    const double reach = kReach * stroke.half_width[i];
    const int bottom = std::min(height - 1, static_cast<int>(r.y + reach));
    const int right = std::min(width - 1, static_cast<int>(r.x + reach));
    for (int y = std::max(0, static_cast<int>(r.y - reach)); y <= bottom; ++y) {
      for (int x = std::max(0, static_cast<int>(r.x - reach)); x <= right; ++x) {
        const double phi = radial_basis(distance({x + 0.5, y + 0.5}, r), stroke.half_width[i]);
        out.direction.at(x, y) = out.direction.at(x, y) + phi * step;
        out.strength.at(x, y) = std::max(out.strength.at(x, y), phi);
      }
    }
  }
  for (std::size_t i = 0; i < out.direction.cells.size(); ++i) {
    Point& v = out.direction.cells[i];
    const double size = length(v);
    v = size > 1e-12 ? 1 / size * v : Point{};
    if (size <= 1e-12) out.strength.cells[i] = 0;
  }
  return out;
}

}  // namespace footlight::planner
