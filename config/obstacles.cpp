// SPDX-License-Identifier: Apache-2.0
#include "config/obstacles.hpp"

#include <algorithm>
#include <cmath>

namespace footlight::config {
namespace {

constexpr double kTouch_m = 1e-5;

double cross(Point a, Point b) { return a.x * b.y - a.y * b.x; }

struct Extent {
  Point low{1e300, 1e300};
  Point high{-1e300, -1e300};

  void take(Point p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
};

Extent extent_of(const std::vector<Point>& points) {
  Extent out;
  for (const Point p : points) out.take(p);
  return out;
}

/// Whether some of the way lies in the cell, deeper than the touch. Cyrus and Beck's clipping against each side.
bool crosses(Point from, Point to, const std::vector<Point>& outline) {
  double first = 0;
  double last = 1;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Point side = outline[(i + 1) % outline.size()] - outline[i];
    const double at_from = cross(side, from - outline[i]) / length(side) - kTouch_m;  // inside is left of a side
    const double at_to = cross(side, to - outline[i]) / length(side) - kTouch_m;
    if (at_from < 0 && at_to < 0) return false;
    if (at_from < 0) first = std::max(first, at_from / (at_from - at_to));
    if (at_to < 0) last = std::min(last, at_from / (at_from - at_to));
  }
  return first <= last;
}

bool encloses(const std::vector<Point>& corners, Point p) {
  bool inside = false;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Point a = corners[i];
    const Point b = corners[(i + 1) % corners.size()];
    if ((a.y > p.y) == (b.y > p.y)) continue;
    if (p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
  }
  return inside;
}

/// A convex cell is reached by the polygon where one of its sides passes through it, or where all of it is inside.
bool reaches(const std::vector<Point>& corners, Point centre, const std::vector<Point>& outline) {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (crosses(corners[i], corners[(i + 1) % corners.size()], outline)) return true;
  }
  return encloses(corners, centre);
}

template <class Reached>
std::vector<CellIndex> cells_where(const Grid& grid, Reached reached) {
  std::vector<CellIndex> out;
  for (int i = 0; i < grid.size(); ++i) {
    const CellIndex cell = CellIndex::of(i);
    if (reached(cell)) out.push_back(cell);
  }
  return out;
}

Extent floor_of(const Grid& grid) {
  Extent out;
  for (const int row : {0, std::min(1, grid.rows() - 1), std::max(0, grid.rows() - 2), grid.rows() - 1}) {
    for (const int column : {0, std::min(1, grid.columns() - 1), std::max(0, grid.columns() - 2), grid.columns() - 1}) {
      for (const Point p : grid.outline(grid.index({column, row}))) out.take(p);
    }
  }
  return out;
}

}  // namespace

std::vector<CellIndex> cells_of_polygon(const Grid& grid, const std::vector<Point>& corners) {
  const Extent box = extent_of(corners);
  const double reach_m = 1.2 * grid.pitch_m();  // no outline is farther from its centre
  return cells_where(grid, [&](CellIndex cell) {
    const Point centre = grid.centre(cell);
    const bool near = centre.x > box.low.x - reach_m && centre.x < box.high.x + reach_m &&
                      centre.y > box.low.y - reach_m && centre.y < box.high.y + reach_m;
    return near && reaches(corners, centre, grid.outline(cell));
  });
}

std::vector<CellIndex> cells_of_map(const Grid& grid, const Mask& map) {
  const Extent floor = floor_of(grid);
  const Point pixel{(floor.high.x - floor.low.x) / map.width(), (floor.high.y - floor.low.y) / map.height()};
  const auto column_of = [&](double x) { return (x - floor.low.x) / pixel.x; };
  const auto row_of = [&](double y) { return (floor.high.y - y) / pixel.y; };
  const bool square = grid.kind() == GridKind::square;
  return cells_where(grid, [&](CellIndex cell) {
    const auto outline = grid.outline(cell);
    const Extent box = extent_of(outline);
    const int first_x = std::max(0, static_cast<int>(std::floor(column_of(box.low.x + kTouch_m))));
    const int last_x = std::min(map.width() - 1, static_cast<int>(std::floor(column_of(box.high.x - kTouch_m))));
    const int first_y = std::max(0, static_cast<int>(std::floor(row_of(box.high.y - kTouch_m))));
    const int last_y = std::min(map.height() - 1, static_cast<int>(std::floor(row_of(box.low.y + kTouch_m))));
    for (int y = first_y; y <= last_y; ++y) {
      for (int x = first_x; x <= last_x; ++x) {
        if (!map.at(x, y)) continue;
        if (square) return true;
        const Point low{floor.low.x + x * pixel.x, floor.high.y - (y + 1) * pixel.y};
        const std::vector<Point> corners{low, low + Point{pixel.x, 0}, low + pixel, low + Point{0, pixel.y}};
        if (reaches(corners, grid.centre(cell), outline)) return true;
      }
    }
    return false;
  });
}

}  // namespace footlight::config
