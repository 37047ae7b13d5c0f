// SPDX-License-Identifier: Apache-2.0
#include "planner/formation/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/check.hpp"
#include "planner/formation/spread.hpp"

namespace footlight::planner {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kUp = kPi / 2;  // upstage
constexpr double kRowOfThree = std::numbers::sqrt3 / 2;

Point on_circle(double radius, double angle) { return {radius * std::cos(angle), radius * std::sin(angle)}; }

/// Share of the way of person k from the first to the last; the middle for one alone.
double share(int k, int people) { return people > 1 ? static_cast<double>(k) / (people - 1) : 0.5; }

std::vector<Point> line(int people) {
  std::vector<Point> out;
  for (int k = 0; k < people; ++k) out.push_back({share(k, people) - 0.5, 0});
  return out;
}

/// Ranks at which files and ranks of a block of this size are as far from each other as can be had.
int fitting_rows(int people, double width, double height) {
  int best = 1;
  double least = std::numeric_limits<double>::infinity();
  for (int rows = 1; rows <= people; ++rows) {
    const int files = (people + rows - 1) / rows;
    if ((rows - 1) * files >= people) continue;  // the last rank would be empty
    const double file_m = files > 1 ? width / (files - 1) : width;
    const double rank_m = rows > 1 ? height / (rows - 1) : height;
    const double uneven = std::abs(std::log(file_m / rank_m));
    if (uneven < least) {
      least = uneven;
      best = rows;
    }
  }
  return best;
}

/// Files and ranks one apart.
std::vector<Point> block(const Shape& shape, const Part& part, int people) {
  int rows = shape.rows;
  if (rows == 0 && part.width_m > 0 && part.height_m > 0) rows = fitting_rows(people, part.width_m, part.height_m);
  if (rows == 0) rows = static_cast<int>(std::lround(std::sqrt(people)));
  rows = std::min(rows, people);
  const int files = (people + rows - 1) / rows;
  std::vector<Point> out;
  for (int k = 0; k < people; ++k) {
    const int row = k / files;
    const int here = std::min(files, people - row * files);
    out.push_back({k % files - (here - 1) / 2.0, static_cast<double>(row)});
  }
  return out;
}

/// Ranks of one, two, three ... from the point, neighbours one apart.
std::vector<Point> wedge(int people) {
  std::vector<Point> out;
  for (int row = 0; static_cast<int>(out.size()) < people; ++row) {
    const int here = std::min(row + 1, people - static_cast<int>(out.size()));
    for (int k = 0; k < here; ++k) out.push_back({k - (here - 1) / 2.0, row * kRowOfThree});
  }
  return out;
}

std::vector<Point> chevron(int people) {
  std::vector<Point> out;
  for (int k = 0; k < people; ++k) {
    const double x = share(k, people) - 0.5;
    out.push_back({x, std::abs(x)});
  }
  return out;
}

std::vector<Point> circle(int people) {
  const double golden = kPi * (3 - std::sqrt(5.0));
  std::vector<Point> out;
  for (int k = 0; k < people; ++k) out.push_back(on_circle(std::sqrt((k + 0.5) / people), kUp + k * golden));
  return out;
}

std::vector<Point> ring(int people) {
  std::vector<Point> out;
  for (int k = 0; k < people; ++k) out.push_back(on_circle(1, kUp + 2 * kPi * k / people));
  return out;
}

std::vector<Point> arc(int people, double angle) {
  std::vector<Point> out;
  for (int k = 0; k < people; ++k) out.push_back(on_circle(1, kUp + angle * (0.5 - share(k, people))));
  return out;
}

/// Archimedes' spiral r = angle / last; its length up to an angle in closed form, turned round by halving.
std::vector<Point> spiral(int people, double turns) {
  const double last = 2 * kPi * turns;
  const auto length_to = [](double angle) { return angle * std::sqrt(1 + angle * angle) + std::asinh(angle); };
  std::vector<Point> out;
  for (int k = 0; k < people; ++k) {
    const double wanted = share(k, people) * length_to(last);
    double low = 0;
    double high = last;
    for (int halving = 0; halving < 60; ++halving) {
      const double middle = (low + high) / 2;
      (length_to(middle) < wanted ? low : high) = middle;
    }
    out.push_back(on_circle(high / last, kUp + high));
  }
  return out;
}

struct Extent {
  Point low;
  Point high;
};
Extent extent_of(const std::vector<Point>& points) {
  Extent out{points.front(), points.front()};
  for (const Point p : points) {
    out.low = {std::min(out.low.x, p.x), std::min(out.low.y, p.y)};
    out.high = {std::max(out.high.x, p.x), std::max(out.high.y, p.y)};
  }
  return out;
}

bool is_round(Shape::Kind kind) {
  return kind == Shape::Kind::circle || kind == Shape::Kind::ring || kind == Shape::Kind::arc ||
         kind == Shape::Kind::spiral;
}

std::vector<Point> points_of(const Shape& shape, const Part& part, int people) {
  switch (shape.kind) {
    case Shape::Kind::line:
      return line(people);
    case Shape::Kind::block:
      return block(shape, part, people);
    case Shape::Kind::circle:
      return circle(people);
    case Shape::Kind::ring:
      return ring(people);
    case Shape::Kind::arc:
      return arc(people, shape.angle_rad);
    case Shape::Kind::spiral:
      return spiral(people, shape.turns);
    case Shape::Kind::wedge:
      return wedge(people);
    case Shape::Kind::chevron:
      return chevron(people);
  }
  FL_CHECK(false);
}

/// Metres for a unit to the side and for one upstage. @param apart of neighbours, in units
Point scale_of(const Shape& shape, const Part& part, const std::vector<Point>& points, double apart, double spacing_m) {
  if (is_round(shape.kind) && part.radius_m > 0) return {part.radius_m, part.radius_m};
  if (!is_round(shape.kind) && (part.width_m > 0 || part.height_m > 0)) {
    const auto [low, high] = extent_of(points);
    const double wide = high.x - low.x;
    const double high_up = high.y - low.y;
    double x = part.width_m > 0 && wide > 0 ? part.width_m / wide : 0;
    double y = part.height_m > 0 && high_up > 0 ? part.height_m / high_up : 0;
    if (x == 0) x = y > 0 ? y : 1;
    if (y == 0) y = x;
    return {x, y};
  }
  const double scale = std::isfinite(apart) ? spacing_m / apart : 1.0;
  return {scale, scale};
}

}  // namespace

Laid lay_shape(const Shape& shape, const Part& part, int people, double spacing_m) {
  FL_CHECK(people >= 1);
  Laid out{points_of(shape, part, people), 0};
  if (!is_round(shape.kind)) {
    const auto [low, high] = extent_of(out.points);
    const Point middle = 0.5 * (low + high);
    for (Point& p : out.points) p = p - middle;
  }
  const Point scale = scale_of(shape, part, out.points, least_distance(out.points), spacing_m);
  for (Point& p : out.points) p = {scale.x * p.x, scale.y * p.y};
  out.apart_m = least_distance(out.points);
  if (shape.kind == Shape::Kind::circle && people > 1) {
    // Cells have room up to half of a cell outside of the edge: solves pi (r + a / 2)^2 = n a^2.
    out.apart_m = std::min(2.0, 1 / (std::sqrt(people / kPi) - 0.5)) * scale.x;
  }
  return out;
}

}  // namespace footlight::planner
