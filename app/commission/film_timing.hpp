// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "app/commission/flash_sequence.hpp"
#include "config/lamp_film.hpp"

namespace footlight::app {

/// Where in a film the sequence is.
struct FilmTiming {
  double start_s = 0;  ///< film time of its beginning
  double step_s = 0;   ///< film time of a step
  double fit = 0;      ///< correlation of lights seen and lamps lit, part by part; at most 1

  [[nodiscard]] double begins_s(const FlashPart& part) const { return start_s + part.begins * step_s; }
  [[nodiscard]] double ends_s(const FlashPart& part) const { return start_s + (part.begins + part.steps) * step_s; }
};

/// Light of a spot below which it counts as noise: a quarter of what nine of ten strong spots of the film have at
/// least. 0 when no frame has spots.
[[nodiscard]] float least_light(const config::LampFilm& film);

/// Finds the sequence by how many lights shine when: the beginning and the step for which the lights seen in each part
/// correlate best with the lamps that shine in it. The film may be played at another rate than it was taken (slow
/// motion of two, four, eight times; the step up to 6 % off) and may begin and end whenever it likes.
/// @param step_s as it was played  Deterministic. Complexity: O(400 x film length / step x parts)
/// @return nothing when the film is shorter than the sequence
[[nodiscard]] std::optional<FilmTiming> find_sequence(const config::LampFilm& film, const FlashSequence& sequence,
                                                      double step_s);

/// Below this `fit` it is not the sequence that was found.
inline constexpr double kLeastFit = 0.85;

}  // namespace footlight::app
