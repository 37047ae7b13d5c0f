// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/film.hpp"
#include "core/grid.hpp"

namespace footlight::planner {

/// Exactly so many points in a picture, evenly over all of it (Xu 2015, section 3.1). First density sampling: the pixel
/// in the middle of every square of as much area as one person has, where it is in the picture. The number is made
/// exact by roulette wheel: points are taken out of squares with little picture in them, or put into those without a
/// point and with much picture, each with a chance in proportion. Then mutual repulsion: everybody is pushed away from
/// neighbours nearer than 1.4 times the even distance, in small steps that stay in the picture and become smaller.
/// The paper names neither the chances nor the force; these are ours.
/// @param picture with at least one pixel  @return pixels (x to the right, y downward), pixel i covering [i, i + 1)
/// Depends on the seed and nothing else. O(pixels + people x steps)
[[nodiscard]] std::vector<Point> fill_picture(const Mask& picture, int people, std::uint64_t seed);

}  // namespace footlight::planner
