// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "app/commission/film_timing.hpp"
#include "config/lamp_film.hpp"

namespace footlight::app {

/// Where the picture of one frame lies relative to the picture of another: x' = a x + b y + c, y' = d x + e y + f.
struct PictureShift {
  std::array<double, 6> m{1, 0, 0, 0, 1, 0};
  [[nodiscard]] config::LightSpot of(const config::LightSpot& spot) const;
  [[nodiscard]] PictureShift inverse() const;
};

/// The spots of one frame, by place.
class SpotIndex {
 public:
  /// @param reach_px the furthest that is ever asked for
  SpotIndex(const std::vector<config::LightSpot>& spots, float least_light, double reach_px);
  /// The nearest spot within `radius_px` (at most the reach), or null. @param beyond_px those that are nearer do not
  /// count
  [[nodiscard]] const config::LightSpot* nearest(double x, double y, double radius_px, double beyond_px = -1) const;

 private:
  [[nodiscard]] std::size_t bucket(int column, int row) const;
  std::vector<config::LightSpot> spots_;
  std::vector<std::uint32_t> begins_;
  double reach_px_;
  double x0_ = 0;
  double y0_ = 0;
  int columns_ = 0;
  int rows_ = 0;
};

/// A light that was seen while all lamps shone: the place is that in the picture of the reference frame.
struct LightSite {
  config::LightSpot place;
  double radius_px = 0;               ///< within which it is looked for: 0.4 of the way to its neighbour
  std::vector<double> light_of_part;  ///< mean light in the middle of each part of the sequence
};

struct TrackedFilm {
  std::vector<LightSite> sites;
  std::size_t reference = 0;  ///< frame
  double most_moved_px = 0;   ///< how far the picture was from the reference frame's at most
};

/// Follows the lights through the film: a hand that shakes moves the picture. Between two frames the picture may move
/// by 0.4 of the distance of two lamps, and by twice that distance while all lamps are dark. Errors: nothing; without
/// lights there are no sites. Deterministic. Complexity: O(frames x sites)
[[nodiscard]] TrackedFilm track_lamps(const config::LampFilm& film, const FlashSequence& sequence,
                                      const FilmTiming& timing);

}  // namespace footlight::app
