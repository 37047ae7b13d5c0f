// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/grid.hpp"

namespace footlight::planner {

/// Two points that are neighbours, by their numbers; a < b.
struct DelaunayEdge {
  std::uint32_t a = 0;
  std::uint32_t b = 0;

  friend auto operator<=>(const DelaunayEdge&, const DelaunayEdge&) = default;
};

/// The Delaunay graph of points on the floor (G(S, E_S) of Xu 2015, section 3.2): pairs that some circle passes through
/// which has no other point inside; planar and connected. Where four or more lie on one empty circle, as the cells of a
/// grid do, that circle's polygon is there and none of its diagonals, of which any triangulation takes some by chance:
/// so the graph depends on where the points are and not on their order. A pair whose side of the Voronoi diagram is
/// shorter than a ten-thousandth of its distance counts as such a diagonal (none of a shortest tree through all points
/// is, so that the graph stays connected).
///
/// Boost.Polygon's sweep (Fortune 1987) with exact predicates, on places rounded to 2^-30 of the extent: two points
/// nearer than that are one, the later linked to the first. @return ascending. O(points log points)
[[nodiscard]] std::vector<DelaunayEdge> delaunay_edges(std::span<const Point> points);

}  // namespace footlight::planner
