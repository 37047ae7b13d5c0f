// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "planner/motion/crowd.hpp"
#include "planner/painted/scene.hpp"

namespace footlight::planner::test {

/// The cells of a party as pixels of the scene.
inline PixelSet pixels_of_cells(const PaintedScene& scene, const std::vector<CellIndex>& cells) {
  const Grid& grid = scene.ways->grid();
  std::vector<char> in(static_cast<std::size_t>(grid.size()), 0);
  for (const CellIndex cell : cells) in[cell.at()] = 1;
  PixelSet out(scene.width, scene.height);
  for (int y = 0; y < scene.height; ++y) {
    for (int x = 0; x < scene.width; ++x) {
      out.at(x, y) = static_cast<std::uint8_t>(in[grid.nearest(scene.floor.to_floor({x + 0.5, y + 0.5})).at()]);
    }
  }
  return out;
}

/// Straight from the middle of the one shape to that of the other, as wide as the first is deep.
inline Stroke straight_stroke(const PaintedScene& scene, const std::vector<Point>& from, const std::vector<Point>& to) {
  const auto middle = [&](const std::vector<Point>& points) {
    Point sum;
    for (const Point p : points) sum = sum + 1 / static_cast<double>(points.size()) * p;
    return scene.floor.to_pixel(sum);
  };
  const auto [low, high] = std::minmax_element(from.begin(), from.end(), [](Point a, Point b) { return a.y < b.y; });
  const double half = std::max(2.0, 0.5 * (high->y - low->y) / scene.floor.pixel_m);
  Stroke out;
  const Point tail = middle(from);
  const Point head = middle(to);
  const int pieces = std::max(2, static_cast<int>(distance(tail, head) / 2));
  for (int k = 0; k <= pieces; ++k) out.line.push_back(tail + double(k) / pieces * (head - tail));
  out.half_width.assign(out.line.size(), half);
  out.skeleton = out.line;
  out.fall = 100;
  out.pixels = PixelSet(scene.width, scene.height);
  const Point way = head - tail;
  for (int y = 0; y < scene.height; ++y) {
    for (int x = 0; x < scene.width; ++x) {
      const Point at{x + 0.5, y + 0.5};
      const double share = std::clamp(dot(at - tail, way) / std::max(1e-9, squared_length(way)), 0.0, 1.0);
      out.pixels.at(x, y) = distance(at, tail + share * way) <= half ? 1 : 0;
    }
  }
  return out;
}

/// What a painting would say that leads the people of a task to its places: a shape where those of a group stand, a
/// shape where their places are. Everybody stands, and shall stand, on a cell of her own.
/// @param strokes a straight one from the one to the other; else people find their way
/// @param cells on which people stand; nothing: those of the task's floor
inline PaintedScene painted_between(const MotionTask& task, bool strokes, const Ways* cells = nullptr) {
  constexpr int kResolution = 128;
  PaintedScene out;
  out.ways.emplace(cells != nullptr ? *cells : task.floor->ways());
  const Grid& grid = out.ways->grid();
  const double edge = grid.pitch_m() / 2;
  const Point low = task.floor->low() - Point{edge, edge};
  const Point high = task.floor->high() + Point{edge, edge};
  out.floor = {{low.x, high.y}, std::max(high.x - low.x, high.y - low.y) / kResolution};
  out.width = static_cast<int>(std::ceil((high.x - low.x) / out.floor.pixel_m - 1e-9));
  out.height = static_cast<int>(std::ceil((high.y - low.y) / out.floor.pixel_m - 1e-9));
  out.background = out.blocked = PixelSet(out.width, out.height);
  out.background_field = Raster<Point>(out.width, out.height);
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) {
      const Point at = out.floor.to_floor({x + 0.5, y + 0.5});
      out.blocked.at(x, y) = task.floor->nearest(at, out.ways->keep_m()) ? 1 : 0;
    }
  }
  struct Ends {
    std::vector<CellIndex> begin, end;
  };
  std::map<std::uint32_t, Ends> groups;
  for (std::size_t i = 0; i < task.people(); ++i) {
    groups[task.group[i]].begin.push_back(grid.nearest(task.from[i]));
    groups[task.to_group[i]].end.push_back(grid.nearest(task.to[i]));
  }
  // From the left to the right: who is in front in the one shape is in front in the other.
  const auto ordered = [&](std::vector<CellIndex>& line) {
    std::vector<Point> at;
    const auto across = [&](CellIndex cell) { return std::pair(grid.centre(cell).x, grid.centre(cell).y); };
    std::sort(line.begin(), line.end(), [&](CellIndex a, CellIndex c) { return across(a) < across(c); });
    for (const CellIndex cell : line) at.push_back(grid.centre(cell));
    return at;
  };
  for (auto& [group, ends] : groups) {
    std::vector<Point> from = ordered(ends.begin);
    std::vector<Point> to = ordered(ends.end);
    PaintedScene::Party party;
    party.people = static_cast<int>(ends.begin.size());
    party.orders = {1, 2};
    party.shapes = {pixels_of_cells(out, ends.begin), pixels_of_cells(out, ends.end)};
    auto& leg = party.legs.emplace_back();
    if (strokes) {
      leg.strokes.push_back(straight_stroke(out, from, to));
      leg.fields.push_back(flow_field(leg.strokes.back(), out.width, out.height));
    }
    party.places = {std::move(from), std::move(to)};
    party.begin = std::move(ends.begin);
    party.end = std::move(ends.end);
    out.parties.push_back(std::move(party));
  }
  return out;
}

}  // namespace footlight::planner::test
