// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <string>
#include <type_traits>
#include <vector>

#include "config/media.hpp"
#include "core/result.hpp"

namespace footlight::config {

/// A point of light in a frame: pixels from the upper left corner, the centre of the first pixel is (0, 0); and how
/// much brighter than its surroundings, in grey values (0..255).
struct LightSpot {
  float x = 0;
  float y = 0;
  float light = 0;
};
static_assert(std::is_trivially_copyable_v<LightSpot> && sizeof(LightSpot) == 12);

struct LampFrame {
  double time_s = 0;  ///< from the beginning of the film; ascends
  std::vector<LightSpot> spots;
};

/// A film of lamps, of which nothing is kept but points of light.
struct LampFilm {
  int width = 0;   ///< pixels
  int height = 0;  ///< pixels
  std::vector<LampFrame> frames;
};

/// What is looked for.
struct SpotSearch {
  double radius = 0.002;  ///< of a lamp's light, about, as a share of the frame's width; 0.0002..0.05
  int most_spots = 4096;  ///< in a frame; of more the brightest are kept. 1..65,536
};

/// Decodes a film in a child process (`footlight-decode`), which a broken or hostile file may kill without harm, and
/// finds the points of light in each frame there. What the child sends is checked like any other input.
/// Errors as of decode_video.
[[nodiscard]] Result<LampFilm> decode_lamps(const std::string& path, const SpotSearch& search,
                                            const MediaLimits& limits = {}, const std::atomic<bool>* stop = nullptr);

}  // namespace footlight::config
