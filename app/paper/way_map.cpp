// SPDX-License-Identifier: Apache-2.0
#include "app/paper/way_map.hpp"

#include <algorithm>
#include <cmath>

#include "app/paper/drawn_floor.hpp"

namespace footlight::app {
namespace {

constexpr Ink kInk{0.05, 0.05, 0.05};
constexpr Ink kFaint{0.38, 0.38, 0.38};
constexpr Ink kHair{0, 0, 0, 0.25};

}  // namespace

void draw_way_map(Canvas& canvas, Point corner, double size, const Grid& grid, const Part& part, std::size_t i,
                  Ink colour) {
  const Point here = grid.centre(part[i].cell);
  const Point before = i > 0 ? grid.centre(part[i - 1].cell) : here;
  const Point next = i + 1 < part.size() ? grid.centre(part[i + 1].cell) : here;
  const auto reach = [&](Point to) { return std::max(std::abs(to.x - here.x), std::abs(to.y - here.y)); };
  // A short way after a long one is what matters: where the long one came from is then off the map.
  constexpr double kLongBefore = 5;
  const bool far = i + 1 < part.size() && reach(before) > kLongBefore * std::max(reach(next), grid.pitch_m());
  const Point from = far ? here : before;
  const auto [left, right] = std::minmax({here.x, from.x, next.x});
  const auto [low, high] = std::minmax({here.y, from.y, next.y});
  const Point middle{(left + right) / 2, (low + high) / 2};
  const double half = std::max(2.5 * grid.pitch_m(), 0.62 * std::max(right - left, high - low));
  const double scale = size / (2 * half);
  const auto at = [&](Point p) {
    return Point{corner.x + size / 2 + (p.x - middle.x) * scale, corner.y + size / 2 - (p.y - middle.y) * scale};
  };
  cairo_t* c = canvas.cairo();
  cairo_save(c);
  cairo_rectangle(c, corner.x, corner.y, size, size);
  cairo_clip(c);
  canvas.ink(kOnPaper.centre_line);
  canvas.stroke_line(at({0, middle.y - half}), at({0, middle.y + half}), 0.4);
  canvas.ink(kHair);  // the downstage edge
  canvas.stroke_line(at({middle.x - half, 0}), at({middle.x + half, 0}), 0.8);
  canvas.ink(kFaint);
  if (i > 0) {
    canvas.stroke_line(at(before), at(here), 0.4);
    canvas.ring(at(before), 1.8, 0.6);
  }
  canvas.ink(kInk);
  if (i + 1 < part.size()) {
    canvas.stroke_line(at(here), at(next), 1);
    canvas.arrow_head(at(here), at(next), 4.5);
  }
  canvas.disc(at(here), 2.6);
  canvas.ink(colour);
  canvas.disc(at(here), 1.9);
  cairo_restore(c);
  canvas.ink(kHair);
  canvas.stroke_box(corner, size, size, 0.3);
}

void draw_floor_map(Canvas& canvas, Point corner, double width, double height, const Grid& grid, const Part& part,
                    Ink colour) {
  Frame frame(grid, corner, width, height);
  frame.corner.x += width - frame.width();
  canvas.ink(kInk);
  canvas.stroke_box(frame.corner, frame.width(), frame.height(), 0.5);
  canvas.ink(kOnPaper.centre_line);
  canvas.stroke_line(frame.at({0, frame.low.y}), frame.at({0, frame.high.y}), 0.4);
  cairo_t* c = canvas.cairo();
  for (const Place& place : part) {
    const Point at = frame.at(grid.centre(place.cell));
    cairo_line_to(c, at.x, at.y);
  }
  canvas.ink(kInk);
  cairo_set_line_width(c, 0.5);
  cairo_stroke(c);
  canvas.ring(frame.at(grid.centre(part.front().cell)), 2, 0.6);
  canvas.disc(frame.at(grid.centre(part.back().cell)), 2.2);
  canvas.ink(colour);
  canvas.disc(frame.at(grid.centre(part.back().cell)), 1.5);
}

}  // namespace footlight::app
