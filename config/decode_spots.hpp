// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "config/lamp_film.hpp"

namespace footlight::config {

/// Points of light in a grey frame (8 bits): local maxima of the difference of two Gaussians (the wider one is the
/// surroundings) above six times its noise, which is measured as the median absolute deviation; their centre is that of
/// the light in 3 x 3 pixels. No two are nearer than twice the radius. In order of brightness.
/// @param radius_px of a lamp's light  Complexity: O(pixels x radius)
[[nodiscard]] std::vector<LightSpot> find_spots(const cv::Mat& grey, double radius_px, std::size_t most_spots);

}  // namespace footlight::config
