// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "app/commission/film_timing.hpp"
#include "app/commission/flash_sequence.hpp"
#include "config/lamp_film.hpp"
#include "core/result.hpp"

namespace footlight::app {

/// A light of the film that flashes.
struct SeenLight {
  config::LightSpot place;          ///< in the picture of the reference frame
  std::optional<std::size_t> lamp;  ///< whose word it shows; nothing: it flashes and cannot be read
  bool corrected = false;           ///< one bit of it was wrong
};

/// What a film of a flash sequence says.
struct FilmReading {
  FilmTiming timing;
  double reference_s = 0;         ///< film time of the reference frame
  std::vector<SeenLight> lights;  ///< a lamp and its reflections show the same word
  std::size_t steady = 0;         ///< lights that do not flash: no lamps of the floor
  double most_moved_px = 0;       ///< how far the hand moved the picture
};

/// Reads who flashes where. Errors (ErrorKind::input): no light is seen; the film is shorter than the sequence; the
/// sequence is not found in it; it is the sequence of another rig.
/// @param step_s as it was played  @param name of the film, for messages
/// Deterministic. Complexity: O(frames x lamps)
[[nodiscard]] Result<FilmReading> read_flashes(const config::LampFilm& film, const FlashSequence& sequence,
                                               double step_s, const std::string& name);

}  // namespace footlight::app
