// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "planner/painted/raster.hpp"

namespace footlight::planner {

/// The middle line of a painted stroke, from its tail (where people come from) to its head.
struct Stroke {
  std::vector<Point> line;         ///< pixels; evenly spaced, at least two
  std::vector<double> half_width;  ///< of the stroke at each point of the line, pixels
  std::vector<Point> skeleton;     ///< of which the line was made, pixels, in the same sense
  double fall = 0;                 ///< brightness at the tail less that at the head, 0..255
  PixelSet pixels;                 ///< what is painted

  [[nodiscard]] double length_px() const;
};

/// Why a stroke is none.
enum class NoStroke {
  empty,        ///< nothing is painted
  no_gradient,  ///< its brightness neither falls nor rises along it: the sense cannot be decided
};

struct StrokeResult {
  std::optional<Stroke> stroke;
  NoStroke why_not = NoStroke::empty;
};

/// Brightness must fall by so much from tail to head, of 255.
inline constexpr double kLeastFall = 10;

/// What a stroke says: its skeleton (Zhang-Suen) without its forks, drawn out to the ends of the paint and smoothed;
/// the sense from the brightness, brighter is nearer the tail; the width from the distance to the edge.
///
/// Source: Kang, Kim 2014, 3.2.1 and 3.2.2. The paper sorts the skeleton's pixels by brightness; a brush's texture
/// would shuffle them. Here the way along the skeleton gives the order and brightness only the sense: a least squares
/// line through the mean brightness of the stroke across each point must fall by `kLeastFall` and explain a third of
/// the variance. O(pixels x thickness)
/// @param brightness of each pixel, 0..255
[[nodiscard]] StrokeResult read_stroke(const PixelSet& pixels, const Raster<float>& brightness);

}  // namespace footlight::planner
