// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/grid.hpp"

namespace footlight::planner {

/// Distance of the two points that are nearest to each other, metres; infinity for fewer than two. O(points) where they
/// are spread evenly
[[nodiscard]] double least_distance(std::span<const Point> points);

/// As many of the points as are wanted, spread as widely as was found: points of a mesh thinned until nobody is nearer
/// than the largest distance at which so many are left, then those with the nearest neighbours left out until the
/// number is exact. The order of the points decides among equals; what is left keeps it.
/// @param least_m no two of them may be nearer than this
/// @return fewer points than wanted where the distance leaves no more. O(points x 40 + those left out x log)
[[nodiscard]] std::vector<Point> thin(std::span<const Point> points, std::size_t wanted, double least_m);

}  // namespace footlight::planner
