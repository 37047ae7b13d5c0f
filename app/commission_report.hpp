// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/commission/film_reading.hpp"
#include "app/commission/findings.hpp"
#include "app/commission/floor_fit.hpp"
#include "app/commission/lamps.hpp"
#include "config/lamp_film.hpp"
#include "core/rig.hpp"
#include "core/stage.hpp"

namespace footlight::app {

/// A floor that was looked at, by walk or by film.
struct CommissionReport {
  const Rig& rig;
  const Stage& stage;
  const std::vector<FloorLamp>& lamps;
  const std::vector<std::optional<CellIndex>>& seen;
  Findings findings;
  std::string output;  ///< rig file that was written; empty: none
};

/// What a film adds.
struct FilmReport {
  const config::LampFilm& film;
  const FilmReading& reading;
  const FloorFit& fit;
  const SeenPlaces& places;
};

/// A line for how it went, then one for each thing that is not as the rig says. @param film null after a walk
[[nodiscard]] std::string commission_text(const CommissionReport& report, const FilmReport* film);
[[nodiscard]] std::string commission_json(const CommissionReport& report, const FilmReport* film);

}  // namespace footlight::app
