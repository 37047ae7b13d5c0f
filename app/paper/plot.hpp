// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/paper/canvas.hpp"

namespace footlight::app {

/// A line of a plot; a gap where a value is not a number.
struct PlotLine {
  std::string name;
  std::vector<double> x;
  std::vector<double> y;
};

/// Lines over a common axis. They differ in colour (Okabe, Ito 2008: told apart by people with any colour vision) and
/// in dashes (on a grey printer).
struct Plot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<PlotLine> lines;
  std::optional<double> limit;  ///< a level that is marked
  std::string limit_name;
  bool from_zero = true;
  bool bars = false;  ///< the first line's values as bars of equal width
};

/// @return an SVG, points. Plots without any value say so.
[[nodiscard]] std::string plot_svg(const Plot& plot, double width, double height);

/// Round values that cover [low, high], about `about` of them. @param low < high
[[nodiscard]] std::vector<double> ticks_of(double low, double high, int about);

}  // namespace footlight::app
