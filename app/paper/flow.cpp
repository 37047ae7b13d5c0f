// SPDX-License-Identifier: Apache-2.0
#include "app/paper/flow.hpp"

#include <algorithm>

namespace footlight::app {
namespace {

constexpr Ink kInk{0.05, 0.05, 0.05};
constexpr Ink kFaint{0.38, 0.38, 0.38};
constexpr double kFootPt = 5.5;
constexpr double kGap = 6;

}  // namespace

Flow::Flow(Canvas& canvas, const PaperSize& paper, const Stamp& stamp)
    : canvas_(canvas), paper_(paper), stamp_(stamp) {}

void Flow::begin(const std::string& title) {
  title_ = title;
  page();
  canvas_.bookmark(title);
}

void Flow::page() {
  if (pages_++ > 0) canvas_.next_page();
  const double size = paper_.words_pt;
  const double left = paper_.margin_pt;
  canvas_.text(canvas_.shortened(title_, 2 * size, width()), {left, paper_.margin_pt + 2 * size}, 2 * size, kInk, 0,
               true);
  const double foot = paper_.height_pt - paper_.margin_pt;
  const std::string page = std::to_string(pages_);
  const double room = width() - canvas_.width_of(page, kFootPt) - kGap;
  canvas_.text(stamp_.line_of(canvas_, kFootPt, room), {left, foot}, kFootPt, kFaint, 0);
  canvas_.text(page, {left + width(), foot}, kFootPt, kFaint, 1);
  y_ = paper_.margin_pt + 3.6 * size;
}

void Flow::keep(double height) {
  if (y_ + height > paper_.height_pt - paper_.margin_pt - 2 * kFootPt) page();
}

void Flow::heading(const std::string& words) {
  const double size = 1.25 * paper_.words_pt;
  keep(6 * size);  // with some of what it heads
  y_ += size;
  y_ += canvas_.paragraph(words, {paper_.margin_pt, y_}, width(), size, kInk, true) + 0.3 * size;
}

void Flow::words(const std::string& words, bool bold) {
  const double size = paper_.words_pt;
  keep(canvas_.height_of(words, width(), size, bold));
  y_ += canvas_.paragraph(words, {paper_.margin_pt, y_}, width(), size, kInk, bold) + 0.2 * size;
}

void Flow::row(const std::vector<double>& shares, const std::vector<std::string>& cells, bool bold) {
  const double size = paper_.words_pt;
  double height = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    height = std::max(height, canvas_.height_of(cells[i], shares[i] * width() - kGap, size, bold));
  }
  keep(height + 0.4 * size);
  double x = paper_.margin_pt;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    canvas_.paragraph(cells[i], {x, y_}, shares[i] * width() - kGap, size, kInk, bold);
    x += shares[i] * width();
  }
  y_ += height + 0.2 * size;
  canvas_.ink({0, 0, 0, 0.15});
  canvas_.stroke_line({paper_.margin_pt, y_}, {paper_.margin_pt + width(), y_}, 0.3);
  y_ += 0.2 * size;
}

}  // namespace footlight::app
