// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/import/imported.hpp"
#include "core/grid.hpp"
#include "core/result.hpp"

namespace footlight::app {

/// How places of another program become cells.
struct GridChoice {
  std::optional<Grid> grid;       ///< of a show that is there; nothing is shifted then
  std::optional<double> pitch_m;  ///< else of a square grid; absent: the largest that fits
  double coarsest_m = 2;          ///< largest pitch that is looked for
  double snap_m = 0;              ///< how far people may be moved onto a cell; 0: not at all
};

/// Numbers with two decimals are half a centimetre off.
inline constexpr double kRounding_m = 0.006;
/// A finer floor than this is none.
inline constexpr double kFinestPitch_m = 0.1;

/// A grid under the places of a file: the file's point p lies at p + shift on the stage.
struct FittingGrid {
  Grid grid;
  Point shift;
  double tolerance_m = kRounding_m;  ///< how far a place may be from the middle of its cell

  [[nodiscard]] CellIndex cell(Point at) const { return grid.nearest(at + shift); }
  [[nodiscard]] double off_m(Point at) const { return distance(grid.centre(cell(at)), at + shift); }
};

/// The coarsest square grid on which every place is the middle of a cell, without a shift where that can be: x = 0
/// stays the centre line and y = 0 the edge of the stage. Two cells more than needed on each side, so that people can
/// walk around each other.
/// Errors: a place that is no cell, with its position and how far it is from one; more cells than a stage has.
/// O(places log places)
[[nodiscard]] Result<FittingGrid> fitting_grid(const Imported& imported, const std::vector<ImportedPlace>& places,
                                               const GridChoice& choice);

/// Everybody's cells.
struct OnCells {
  std::vector<std::vector<CellIndex>> cells;  ///< of each formation, in the order of people
  double largest_move_m = 0;
  std::size_t moved = 0;  ///< places farther than `kRounding_m` from their cell
  std::size_t farthest_formation = 0;
  std::size_t farthest_person = 0;
};
/// Errors: a place that is no cell, two people on one, both with their positions.
[[nodiscard]] Result<OnCells> cells_of(const Imported& imported, const FittingGrid& grid);

}  // namespace footlight::app
