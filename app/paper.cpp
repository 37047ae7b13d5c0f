// SPDX-License-Identifier: Apache-2.0
#include "app/paper.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/check.hpp"

namespace footlight::app {
namespace {

constexpr double kFloorWidthPx = 1600;
constexpr double kFloorHeightPx = 1200;
constexpr const char* kEllipsis = "\xE2\x80\xA6";

}  // namespace

Frame::Frame(const Grid& grid) : low(grid.centre(CellIndex(0))), high(low) {
  // The hull of the four edges' cells is the hull of the floor.
  for (int row = 0; row < grid.rows(); ++row) {
    for (int column = 0; column < grid.columns(); ++column) {
      const bool edge = row < 2 || row >= grid.rows() - 2 || column < 2 || column >= grid.columns() - 2;
      if (!edge) continue;
      for (const Point corner : grid.outline(grid.index({column, row}))) {
        low = {std::min(low.x, corner.x), std::min(low.y, corner.y)};
        high = {std::max(high.x, corner.x), std::max(high.y, corner.y)};
      }
    }
  }
  scale = std::min(kFloorWidthPx / (high.x - low.x), kFloorHeightPx / (high.y - low.y));
}

Point Frame::at(Point metres) const {
  return {Paper::kLeftPx + (metres.x - low.x) * scale, Paper::kTopPx + (high.y - metres.y) * scale};
}

Paper::Paper(const Grid& grid, Ink ground)
    : frame_(grid),
      width_(static_cast<int>(std::ceil(kLeftPx + std::max(frame_.width_px(), kNarrowestPx) + kRightPx))),
      height_(static_cast<int>(std::ceil(kTopPx + frame_.height_px() + kBottomPx))),
      surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width_, height_)),
      cairo_(cairo_create(surface_.get())) {
  ink(ground);
  cairo_paint(cairo());
}

void Paper::ink(Ink colour) { cairo_set_source_rgba(cairo(), colour.red, colour.green, colour.blue, colour.alpha); }

void Paper::cell_path(const Grid& grid, CellIndex cell) {
  cairo_new_sub_path(cairo());
  for (const Point corner : grid.outline(cell)) {
    const Point at = frame_.at(corner);
    cairo_line_to(cairo(), at.x, at.y);
  }
  cairo_close_path(cairo());
}

void Paper::line(Point from, Point to) {
  const Point a = frame_.at(from);
  const Point b = frame_.at(to);
  cairo_move_to(cairo(), a.x, a.y);
  cairo_line_to(cairo(), b.x, b.y);
}

void Paper::disc(Point at, double radius_px) {
  cairo_new_path(cairo());
  cairo_arc(cairo(), at.x, at.y, radius_px, 0, 2 * std::numbers::pi);
  cairo_fill(cairo());
}

void Paper::ring(Point at, double radius_px, double width_px) {
  cairo_new_path(cairo());
  cairo_set_line_width(cairo(), width_px);
  cairo_arc(cairo(), at.x, at.y, radius_px - width_px / 2, 0, 2 * std::numbers::pi);
  cairo_stroke(cairo());
}

void Paper::cross(Point at, double radius_px) {
  cairo_set_line_width(cairo(), std::max(1.0, radius_px / 6));
  cairo_move_to(cairo(), at.x - radius_px, at.y - radius_px);
  cairo_line_to(cairo(), at.x + radius_px, at.y + radius_px);
  cairo_move_to(cairo(), at.x - radius_px, at.y + radius_px);
  cairo_line_to(cairo(), at.x + radius_px, at.y - radius_px);
  cairo_stroke(cairo());
}

double Paper::width_of(const std::string& words, double size, bool bold) const {
  cairo_select_font_face(cairo(), "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                         bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cairo(), size);
  cairo_text_extents_t extents;
  cairo_text_extents(cairo(), words.c_str(), &extents);
  return extents.x_advance;
}

void Paper::text(const std::string& words, Point at, double size, Ink colour, double anchor, bool bold) {
  const double width = width_of(words, size, bold);
  ink(colour);
  cairo_move_to(cairo(), at.x - anchor * width, at.y);
  cairo_show_text(cairo(), words.c_str());
  cairo_new_path(cairo());
}

std::string Paper::shortened(const std::string& words, double size, double width_px) const {
  const auto fits = [&](const std::string& part) { return width_of(part, size) <= width_px; };
  if (fits(words)) return words;
  std::string part = words.substr(0, words.find(' '));
  if (fits(part)) return part;
  while (!part.empty()) {
    // A character of UTF-8 is taken off as a whole.
    while (part.size() > 1 && (static_cast<unsigned char>(part.back()) & 0xC0U) == 0x80U) part.pop_back();
    part.pop_back();
    if (!part.empty() && fits(part + kEllipsis)) return part + kEllipsis;
  }
  return {};
}

std::string Paper::png() const {
  std::string out;
  const auto append = [](void* to, const unsigned char* data, unsigned size) {
    static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(data), size);
    return CAIRO_STATUS_SUCCESS;
  };
  FL_CHECK(cairo_surface_write_to_png_stream(surface_.get(), append, &out) == CAIRO_STATUS_SUCCESS);
  return out;
}

}  // namespace footlight::app
