// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "planner/painted/raster.hpp"

namespace footlight::planner {

/// Every pixel the median of itself and its eight neighbours; those beyond the edge count as the nearest. O(pixels)
[[nodiscard]] Raster<double> median_filtered(const Raster<double>& picture);

/// Length of the gradient, by central differences, scaled so that the largest is 1. O(pixels)
[[nodiscard]] Raster<double> edge_map(const Raster<double>& picture);

/// The field that spreads the gradient of an edge map over the picture: everywhere towards the edges, y down.
///
/// Source: Xu, Prince, "Gradient Vector Flow: A New External Force for Snakes", CVPR 1997, Eq. 12-16: the steady state
/// of v_t = mu laplace(v) - (v - grad f) |grad f|^2, by explicit steps of 1/(4 mu) at most, the bound of its
/// section 3.3 for pixels of 1. Stops when nothing changes by more than 1e-4 in a step, or after `most_steps`. O(pixels
/// x steps)
/// @param mu > 0: how far it spreads; 0.2 in the paper
[[nodiscard]] Raster<Point> gradient_vector_flow(const Raster<double>& edges, double mu, int most_steps);

/// What a grey background does to people (Kang, Kim 2014, 3.3.1): median filter, edge map, gradient vector flow,
/// negated when it repels; scaled so that its largest vector is 1, and faded out over `reach_px` from the outline, as
/// the paper applies it around the contour.
/// @param background 1 where it is grey  @param reach_px > 0
[[nodiscard]] Raster<Point> background_field(const PixelSet& background, bool repels, double reach_px);

}  // namespace footlight::planner
