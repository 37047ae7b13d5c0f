// SPDX-License-Identifier: Apache-2.0
#include "planner/painted/stroke.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "planner/painted/skeleton.hpp"

namespace footlight::planner {
namespace {

/// Holes of at most this share of the stroke are the brush's bristles and no loops.
constexpr double kLargestHole = 0.02;
constexpr double kLeastExplained = 1.0 / 3;  // of the variance, by the line

Point unit(Point a) {
  const double size = length(a);
  return size > 0 ? 1 / size * a : Point{};
}

/// Fills the holes that are too small to mean anything. A loop would break the skeleton's way.
PixelSet without_holes(const PixelSet& pixels) {
  PixelSet outside(pixels.width + 2, pixels.height + 2, 1);
  for (int y = 0; y < pixels.height; ++y) {
    for (int x = 0; x < pixels.width; ++x) outside.at(x + 1, y + 1) = pixels.at(x, y) == 0 ? 1 : 0;
  }
  PixelSet out = pixels;
  const double most = std::max(2.0, kLargestHole * static_cast<double>(count(pixels)));
  std::vector<char> seen(outside.cells.size(), 0);
  std::vector<std::size_t> hole;
  const auto width = static_cast<std::size_t>(outside.width);
  for (std::size_t first = 0; first < outside.cells.size(); ++first) {
    if (outside.cells[first] == 0 || seen[first] != 0) continue;
    hole.assign(1, first);
    seen[first] = 1;
    for (std::size_t k = 0; k < hole.size(); ++k) {
      // 4 neighbours: paint hangs together over corners, what is not painted does not.
      for (const std::size_t next : {hole[k] + 1, hole[k] - 1, hole[k] + width, hole[k] - width}) {
        if (next >= outside.cells.size() || outside.cells[next] == 0 || seen[next] != 0) continue;
        seen[next] = 1;
        hole.push_back(next);
      }
    }
    if (static_cast<double>(hole.size()) > most) continue;
    for (const std::size_t at : hole) {
      const int x = static_cast<int>(at % width) - 1;
      const int y = static_cast<int>(at / width) - 1;
      if (out.inside(x, y)) out.at(x, y) = 1;
    }
  }
  return out;
}

/// Points of a line every `step` of its length; the last one stays.
std::vector<Point> resampled(const std::vector<Point>& line, double step) {
  std::vector<double> at(line.size(), 0);
  for (std::size_t i = 1; i < line.size(); ++i) at[i] = at[i - 1] + distance(line[i - 1], line[i]);
  const auto pieces = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(at.back() / step)));
  std::vector<Point> out;
  std::size_t k = 0;
  for (std::size_t i = 0; i <= pieces; ++i) {
    const double want = at.back() * static_cast<double>(i) / static_cast<double>(pieces);
    while (k + 2 < line.size() && at[k + 1] < want) ++k;
    const double span = at[k + 1] - at[k];
    const double share = span > 0 ? (want - at[k]) / span : 0;
    out.push_back(line[k] + share * (line[k + 1] - line[k]));
  }
  return out;
}

/// Mean over so many neighbours on both sides, fewer near the ends, which stay.
std::vector<Point> smoothed(const std::vector<Point>& line, std::size_t reach) {
  std::vector<Point> out = line;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const std::size_t n = std::min({reach, i, line.size() - 1 - i});
    Point sum;
    for (std::size_t k = i - n; k <= i + n; ++k) sum = sum + line[k];
    out[i] = 1 / static_cast<double>(2 * n + 1) * sum;
  }
  return out;
}

/// Thinning ends half a width before the paint does: goes on straight until it leaves the paint. The last stretch of a
/// skeleton bends into a corner of a blunt end; it is cut first.
void draw_out(std::vector<Point>& line, const PixelSet& pixels, const Raster<double>& to_edge) {
  const double half = std::max(1.0, bilinear(to_edge, line.back()));
  std::size_t back = 1;
  double cut = 0;
  while (back + 1 < line.size() && cut < half) {
    cut += distance(line[line.size() - back], line[line.size() - back - 1]);
    ++back;
  }
  if (back * 3 < line.size()) line.resize(line.size() - back + 1);
  const std::size_t reach = std::min(line.size() - 1, std::max<std::size_t>(3, static_cast<std::size_t>(2 * half)));
  const Point along = unit(line.back() - line[line.size() - 1 - reach]);
  if (along == Point{}) return;
  for (Point next = line.back() + along; pixels.contains(next); next = next + along) {
    if (pixels.at(static_cast<int>(next.x), static_cast<int>(next.y)) == 0) break;
    line.push_back(next);
  }
}

/// Mean brightness of the paint that is nearest to each point of the line.
std::vector<double> brightness_along(const std::vector<Point>& line, const PixelSet& pixels,
                                     const Raster<float>& brightness) {
  std::vector<double> sum(line.size(), 0);
  std::vector<double> many(line.size(), 0);
  for (int y = 0; y < pixels.height; ++y) {
    for (int x = 0; x < pixels.width; ++x) {
      if (pixels.at(x, y) == 0) continue;
      std::size_t best = 0;
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < line.size(); ++i) {
        const double away = squared_length(line[i] - Point{x + 0.5, y + 0.5});
        if (away < least) {
          least = away;
          best = i;
        }
      }
      sum[best] += static_cast<double>(brightness.at(x, y));
      many[best] += 1;
    }
  }
  for (std::size_t i = 0; i < sum.size(); ++i) {
    sum[i] = many[i] > 0 ? sum[i] / many[i] : std::numeric_limits<double>::quiet_NaN();
  }
  return sum;
}

struct Slope {
  double rise = 0;       // of the fitted line from the first point to the last
  double explained = 0;  // share of the variance
};

Slope fit(const std::vector<double>& values) {
  double n = 0;
  double sx = 0;
  double sy = 0;
  double sxx = 0;
  double sxy = 0;
  double syy = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) continue;
    const double x = static_cast<double>(i) / static_cast<double>(values.size() - 1);
    n += 1;
    sx += x;
    sy += values[i];
    sxx += x * x;
    sxy += x * values[i];
    syy += values[i] * values[i];
  }
  const double vx = n * sxx - sx * sx;
  const double vy = n * syy - sy * sy;
  const double c = n * sxy - sx * sy;
  if (vx <= 0 || vy <= 0) return {};
  return {c / vx, c * c / (vx * vy)};
}

}  // namespace

double Stroke::length_px() const {
  double out = 0;
  for (std::size_t i = 1; i < line.size(); ++i) out += distance(line[i - 1], line[i]);
  return out;
}

StrokeResult read_stroke(const PixelSet& pixels, const Raster<float>& brightness) {
  if (count(pixels) == 0) return {{}, NoStroke::empty};
  const PixelSet whole = without_holes(pixels);
  // Distances to what is not painted, beyond the picture's edge, too.
  PixelSet not_painted(whole.width + 2, whole.height + 2, 1);
  for (int y = 0; y < whole.height; ++y) {
    for (int x = 0; x < whole.width; ++x) not_painted.at(x + 1, y + 1) = whole.at(x, y) == 0 ? 1 : 0;
  }
  const Raster<double> wide = nearest_pixels(not_painted).distance_px;
  Raster<double> to_edge(whole.width, whole.height);
  for (int y = 0; y < whole.height; ++y) {
    for (int x = 0; x < whole.width; ++x) to_edge.at(x, y) = std::max(0.0, wide.at(x + 1, y + 1) - 0.5);
  }
  Stroke out;
  out.pixels = whole;
  out.skeleton = longest_way(thinned(whole));
  std::vector<Point> line = out.skeleton;
  if (line.size() < 2) return {{}, NoStroke::no_gradient};
  double mean_half = 0;
  for (const Point p : line) mean_half += bilinear(to_edge, p) / static_cast<double>(line.size());
  line = smoothed(line, static_cast<std::size_t>(std::clamp(mean_half, 2.0, 12.0)));
  draw_out(line, whole, to_edge);
  std::reverse(line.begin(), line.end());
  draw_out(line, whole, to_edge);
  const double step = std::clamp(mean_half / 2, 1.0, 4.0);
  line = smoothed(resampled(line, step), 2);
  const Slope slope = fit(brightness_along(line, pixels, brightness));
  if (std::abs(slope.rise) < kLeastFall || slope.explained < kLeastExplained) return {{}, NoStroke::no_gradient};
  out.fall = std::abs(slope.rise);
  // draw_out left the line against the skeleton's sense.
  if (slope.rise > 0) {
    std::reverse(line.begin(), line.end());
  } else {
    std::reverse(out.skeleton.begin(), out.skeleton.end());
  }
  for (const Point p : line) out.half_width.push_back(std::max(1.0, bilinear(to_edge, p)));
  out.line = std::move(line);
  return {std::move(out), NoStroke::empty};
}

}  // namespace footlight::planner
