// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "app/paper/words.hpp"
#include "core/grid.hpp"

namespace footlight::app {

/// How a place is called.
enum class PlaceStyle {
  stage,  ///< steps from the centre line, and upstage or downstage of a row that the floor plan names
  drill,  ///< of marching bands: sides, yard lines and college hashes; centre line on the 50, stage's edge the side
          ///< line
};

/// "8 to 5": eight steps for five yards, m.
inline constexpr double kDrillStep_m = 0.5715;

/// In which words places are told.
struct PlaceWords {
  Language language = Language::english;
  PlaceStyle style = PlaceStyle::stage;
  double step_m = kDrillStep_m;  ///< of the stage style
};

/// "3 steps stage left of centre, 2 upstage of row 10", to a quarter of a step. The cell's name says it exactly.
[[nodiscard]] std::string place_in_words(const PlaceWords& words, const Grid& grid, Point at);
/// Row by which places are told, numbered from 1: 1 and every tenth, on small floors every fifth.
[[nodiscard]] bool is_named_row(const Grid& grid, int row_from_1);
/// "upstage left": one of eight. @param walk not zero
[[nodiscard]] Word direction_of(Point walk);
/// "backward left": the same walk as seen by who faces the audience.
[[nodiscard]] Word facing_of(Point walk);

/// A count as people say it: to a hundredth, without trailing zeros.
[[nodiscard]] std::string spoken_count(double count);

}  // namespace footlight::app
