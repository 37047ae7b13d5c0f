// SPDX-License-Identifier: Apache-2.0
#include "app/paper/plot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace footlight::app {
namespace {

constexpr double kLeft = 52;
constexpr double kRight = 12;
constexpr double kTop = 40;
constexpr double kBottom = 34;
constexpr double kWords = 10;
constexpr Ink kInk{0.1, 0.1, 0.1};
constexpr Ink kGrid{0, 0, 0, 0.12};
constexpr Ink kLimit{0.84, 0.37, 0.0};
// Blue, vermilion, bluish green, reddish purple, orange.
constexpr Ink kColours[] = {
    {0.0, 0.45, 0.70}, {0.84, 0.37, 0.0}, {0.0, 0.62, 0.45}, {0.80, 0.47, 0.65}, {0.90, 0.62, 0.0}};
constexpr double kDashes[][2] = {{0, 0}, {6, 3}, {2, 2}, {9, 4}, {1, 3}};
constexpr std::size_t kStyles = std::size(kColours);

struct Span {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void add(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  [[nodiscard]] bool empty() const { return low > high; }
};

class Drawn {
 public:
  Drawn(const Plot& plot, double width, double height)
      : plot_(plot), canvas_(Canvas::svg(width, height)), width_(width), height_(height) {
    for (const PlotLine& line : plot.lines) {
      for (const double value : line.x) x_.add(value);
      for (const double value : line.y) y_.add(value);
    }
    if (plot.limit) y_.add(*plot.limit);
    if (plot.from_zero) y_.add(0);
    if (x_.high - x_.low <= 0) x_.high = x_.low + 1;
    if (y_.high - y_.low <= 0) y_.high = y_.low + 1;
  }

  std::string draw() {
    canvas_.ink({1, 1, 1});
    canvas_.fill_box({0, 0}, width_, height_);
    canvas_.text(plot_.title, {kLeft, 14}, 12, kInk, 0, true);
    const bool nothing = std::ranges::all_of(plot_.lines, [](const PlotLine& line) { return line.x.empty(); });
    if (nothing) {
      canvas_.text("nothing to show", {width_ / 2, height_ / 2}, kWords, kInk, 0.5);
      return canvas_.finish();
    }
    axes();
    plot_.bars ? bars() : lines();
    limit();
    if (plot_.lines.size() > 1) names();
    return canvas_.finish();
  }

 private:
  [[nodiscard]] Point at(double x, double y) const {
    return {kLeft + (x - x_.low) / (x_.high - x_.low) * (width_ - kLeft - kRight),
            height_ - kBottom - (y - y_.low) / (y_.high - y_.low) * (height_ - kTop - kBottom)};
  }

  void axes() {
    const std::vector<double> up = ticks_of(y_.low, y_.high, 5);
    y_.high = std::max(y_.high, up.back());
    for (const double value : up) {
      const Point here = at(x_.low, value);
      canvas_.ink(kGrid);
      canvas_.stroke_line(here, {width_ - kRight, here.y}, 0.6);
      canvas_.text(fmt::format("{:g}", value), {here.x - 5, here.y + 3.5}, kWords, kInk, 1);
    }
    for (const double value : ticks_of(x_.low, x_.high, 10)) {
      const Point here = at(value, y_.low);
      if (value < x_.low || value > x_.high) continue;
      canvas_.ink(kInk);
      canvas_.stroke_line(here, here + Point{0, 4}, 0.6);
      canvas_.text(fmt::format("{:g}", value), {here.x, here.y + 14}, kWords, kInk, 0.5);
    }
    canvas_.ink(kInk);
    canvas_.stroke_line(at(x_.low, y_.low), at(x_.high, y_.low), 0.8);
    canvas_.text(plot_.x_label, {width_ - kRight, height_ - 4}, kWords, kInk, 1);
    canvas_.text(plot_.y_label, {4, 30}, kWords, kInk, 0);
  }

  void style(std::size_t line) {
    canvas_.ink(kColours[line % kStyles]);
    const double* dashes = kDashes[line % kStyles];
    cairo_set_dash(canvas_.cairo(), dashes, dashes[0] > 0 ? 2 : 0, 0);
    cairo_set_line_width(canvas_.cairo(), 1.4);
    cairo_set_line_join(canvas_.cairo(), CAIRO_LINE_JOIN_ROUND);
  }

  void lines() {
    cairo_t* c = canvas_.cairo();
    for (std::size_t l = 0; l < plot_.lines.size(); ++l) {
      const PlotLine& line = plot_.lines[l];
      for (std::size_t i = 0; i < line.x.size(); ++i) {
        const bool begins = i == 0 || !std::isfinite(line.y[i - 1]);
        if (!std::isfinite(line.y[i])) continue;
        const Point here = at(line.x[i], line.y[i]);
        begins ? cairo_move_to(c, here.x, here.y) : cairo_line_to(c, here.x, here.y);
      }
      style(l);
      cairo_stroke(c);
    }
    cairo_set_dash(c, nullptr, 0, 0);
  }

  void bars() {
    const PlotLine& line = plot_.lines.front();
    if (line.x.size() < 2) return;
    const double wide = at(line.x[1], 0).x - at(line.x[0], 0).x;
    canvas_.ink(kColours[0]);
    for (std::size_t i = 0; i < line.x.size(); ++i) {
      const Point top = at(line.x[i], line.y[i]);
      canvas_.fill_box({top.x, top.y}, 0.92 * wide, at(0, y_.low).y - top.y);
    }
  }

  void limit() {
    if (!plot_.limit) return;
    const Point from = at(x_.low, *plot_.limit);
    const double dashes[] = {3, 3};
    cairo_set_dash(canvas_.cairo(), dashes, 2, 0);
    canvas_.ink(kLimit);
    canvas_.stroke_line(from, at(x_.high, *plot_.limit), 1);
    cairo_set_dash(canvas_.cairo(), nullptr, 0, 0);
    canvas_.text(plot_.limit_name, {width_ - kRight - 2, from.y - 4}, kWords, kLimit, 1);
  }

  void names() {
    double x = width_ - kRight;
    for (std::size_t l = plot_.lines.size(); l-- > 0;) {
      const std::string& name = plot_.lines[l].name;
      x -= canvas_.width_of(name, kWords);
      canvas_.text(name, {x, 30}, kWords, kInk, 0);
      cairo_move_to(canvas_.cairo(), x - 30, 26.5);
      cairo_line_to(canvas_.cairo(), x - 5, 26.5);
      style(l);
      cairo_stroke(canvas_.cairo());
      cairo_set_dash(canvas_.cairo(), nullptr, 0, 0);
      x -= 44;
    }
  }

  const Plot& plot_;
  Canvas canvas_;
  double width_;
  double height_;
  Span x_;
  Span y_;
};

}  // namespace

std::vector<double> ticks_of(double low, double high, int about) {
  const double raw = (high - low) / std::max(1, about);
  const double power = std::pow(10, std::floor(std::log10(raw)));
  double step = 10 * power;
  for (const double factor : {5.0, 2.0, 1.0}) {
    if (factor * power >= raw * (1 - 1e-9)) step = factor * power;
  }
  std::vector<double> out;
  const auto first = static_cast<std::int64_t>(std::floor(low / step + 1e-9));
  for (std::int64_t k = first; out.empty() || out.back() < high - 1e-9 * step; ++k) {
    out.push_back(static_cast<double>(k) * step);
  }
  return out;
}

std::string plot_svg(const Plot& plot, double width, double height) { return Drawn(plot, width, height).draw(); }

}  // namespace footlight::app
