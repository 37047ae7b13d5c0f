// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/parts.hpp"

namespace footlight::planner {

/// Places of people on a shape.
struct Laid {
  std::vector<Point> points;  ///< metres, around the shape's middle, not turned; in an order of the shape's own
  double apart_m = 0;  ///< of neighbours: of the two nearest, in a circle as the area of each asks; infinite for one
};

/// Lays people evenly on a shape: along lines by arc length, in a block in files and ranks with the last rank in the
/// middle, in a wedge by ranks of one, two, three ... from its point, in a circle on a sunflower's spiral (Vogel, "A
/// better way to construct the sunflower head", 1979). Depends on nothing but the arguments.
/// @param part gives the size: width and height (block, wedge, chevron; one of them keeps the proportions), width
/// (line), radius (circle, ring, arc, spiral); with none of these neighbours are `spacing_m` apart
/// @param people >= 1  O(people)
[[nodiscard]] Laid lay_shape(const Shape& shape, const Part& part, int people, double spacing_m);

}  // namespace footlight::planner
