// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/commission/film_reading.hpp"
#include "app/commission/lamps.hpp"
#include "core/result.hpp"
#include "core/stage.hpp"

namespace footlight::app {

/// Projective map from the picture to the floor, row by row; pixels to metres.
struct FloorView {
  std::array<double, 9> m{1, 0, 0, 0, 1, 0, 0, 0, 1};
  [[nodiscard]] Point of(double x_px, double y_px) const;
};

/// From where the film was taken.
enum class Viewpoint { audience, stage_left, upstage, stage_right };
[[nodiscard]] std::string_view to_text(Viewpoint viewpoint);

/// How a picture comes onto the floor plan.
struct FitChoice {
  /// Pixels of the lamps (or places of lamps) in the corners, in the picture of the reference frame: A1, the last cell
  /// of row 1, the last cell of all, the last cell of column A.
  std::optional<std::array<Point, 4>> corners;
  std::optional<Viewpoint> from;  ///< nothing: as the rig tells, else the audience
};

/// Where the lights of a film are on the floor.
struct FloorFit {
  FloorView view;
  std::string by;                              ///< "the rig", "the grid", "the corners"
  Viewpoint from = Viewpoint::audience;        ///< the side that is the lowest in the picture
  std::vector<std::optional<CellIndex>> cell;  ///< of each light of the reading; nothing: beside every cell
  double error_m = 0;                          ///< median distance of lights and the centres of their cells
};

/// Registers the lights to the floor plan. Where the rig is right for most lamps it tells by itself where the picture
/// lies: a projective map from four lamps, the one with which most lamps are where the rig says (RANSAC; M. Fischler,
/// R. Bolles, 1981), then least squares over all that agree, in normalised coordinates (direct linear transformation;
/// R. Hartley, "In Defense of the Eight-Point Algorithm", 1997, for the normalisation). Where it is not, the quadrangle
/// around all lights is taken for the edge of the floor as seen from `from`, and improved until the lights are on
/// cells. A rig that is right in a mirror alone is not right.
/// Errors (ErrorKind::input): neither way gives lights on cells. Deterministic.
[[nodiscard]] Result<FloorFit> fit_floor(const FilmReading& reading, const std::vector<FloorLamp>& lamps,
                                         const Stage& stage, const FitChoice& choice);

/// Where each lamp was seen: of several lights with the same word the brightest on a cell counts, the others are
/// reflections; of two lamps on one cell neither is believed.
struct SeenPlaces {
  std::vector<std::optional<CellIndex>> cell;  ///< for each lamp
  std::vector<CellIndex> unread;               ///< cells with a light that flashes and cannot be read
  std::size_t reflections = 0;
  std::size_t beside = 0;  ///< lights that can be read and are on no cell
};
[[nodiscard]] SeenPlaces places_of(const FilmReading& reading, const FloorFit& fit, std::size_t lamps);

}  // namespace footlight::app
