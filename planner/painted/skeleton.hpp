// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "planner/painted/raster.hpp"

namespace footlight::planner {

/// Thins a drawing to lines one pixel wide that hang together as it does.
///
/// Source: Zhang, Suen, "A fast parallel algorithm for thinning digital patterns", Communications of the ACM 27(3),
/// 1984: two passes in turn, until neither takes a pixel. O(pixels x thickness)
[[nodiscard]] PixelSet thinned(PixelSet set);

/// The longest of the shortest ways between two pixels of a skeleton: what remains when forks are pruned. Ways go over
/// 8 neighbours, straight steps 1 long, diagonal ones sqrt(2). Of several parts the one with the longest way.
/// @return middles of the pixels, in order along the way; empty where the skeleton is. O(pixels log pixels)
[[nodiscard]] std::vector<Point> longest_way(const PixelSet& skeleton);

}  // namespace footlight::planner
