// SPDX-License-Identifier: Apache-2.0
#include "planner/painted/lattice_turns.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace footlight::planner {
namespace {

constexpr double kAspectWeight = 0.5;

Point mean(const std::vector<Point>& points) {
  Point sum;
  for (const Point p : points) sum = sum + p;
  return 1 / static_cast<double>(points.size()) * sum;
}

Point unit(Point a) {
  const double size = length(a);
  return size > 0 ? 1 / size * a : Point{1, 0};
}

/// Correlation of where people are along one direction before and along another one after.
double agreement(const std::vector<Point>& before, Point along, const std::vector<Point>& after, Point then) {
  const Point from = mean(before);
  const Point to = mean(after);
  double both = 0;
  double first = 0;
  double second = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const double a = dot(before[i] - from, along);
    const double b = dot(after[i] - to, then);
    both += a * b;
    first += a * a;
    second += b * b;
  }
  return first > 0 && second > 0 ? both / std::sqrt(first * second) : 0;
}

struct Heading {
  Point leaving;
  Point coming;
};

/// Over the width of the stroke at its ends, where it has settled.
Heading heading(const PaintedScene::Leg& leg, const std::vector<Point>& from, const PixelSet& to) {
  if (leg.strokes.empty()) {
    const Point straight = unit(mean(spread_over(to, Lattice(1, 1), {})) - mean(from));
    return {straight, straight};
  }
  const Stroke& stroke = leg.strokes.front();
  const auto& line = stroke.line;
  const auto reach = [&](double half_width) {
    const double step = std::max(1e-9, stroke.length_px() / static_cast<double>(line.size() - 1));
    return std::clamp<std::size_t>(static_cast<std::size_t>(2 * half_width / step), 1, line.size() - 1);
  };
  return {unit(line[reach(stroke.half_width.front())] - line.front()),
          unit(line.back() - line[line.size() - 1 - reach(stroke.half_width.back())])};
}

}  // namespace

double aspect(const PixelSet& shape) {
  int left = shape.width;
  int right = -1;
  int top = shape.height;
  int bottom = -1;
  for (int y = 0; y < shape.height; ++y) {
    for (int x = 0; x < shape.width; ++x) {
      if (shape.at(x, y) == 0) continue;
      left = std::min(left, x);
      right = std::max(right, x);
      top = std::min(top, y);
      bottom = std::max(bottom, y);
    }
  }
  return right < left ? 1 : double(right - left + 1) / (bottom - top + 1);
}

std::vector<LatticeTurn> lattice_turns(const PaintedScene::Party& party, const Lattice& lattice) {
  std::vector<LatticeTurn> out{{}};
  std::vector<Point> before = spread_over(party.shapes.front(), lattice, {});
  const double wide = lattice.width() / lattice.rows();
  for (std::size_t s = 1; s < party.shapes.size(); ++s) {
    const PixelSet& shape = party.shapes[s];
    const auto [leaving, coming] = heading(party.legs[s - 1], before, shape);
    LatticeTurn best;
    double most = -std::numeric_limits<double>::infinity();
    for (int k = 0; k < 8; ++k) {
      const LatticeTurn turn{(k & 4) != 0, (k & 1) != 0, (k & 2) != 0};
      const auto after = spread_over(shape, lattice, turn);
      const double misfit = std::abs(std::log(aspect(shape) / (turn.transposed ? 1 / wide : wide)));
      const double score = agreement(before, leaving, after, coming) +
                           agreement(before, {-leaving.y, leaving.x}, after, {-coming.y, coming.x}) -
                           kAspectWeight * misfit;
      if (score <= most) continue;
      most = score;
      best = turn;
    }
    out.push_back(best);
    before = spread_over(shape, lattice, best);
  }
  return out;
}

}  // namespace footlight::planner
