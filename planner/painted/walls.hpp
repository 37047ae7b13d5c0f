// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/film.hpp"
#include "core/show.hpp"
#include "planner/painted/marks.hpp"

namespace footlight::planner {

/// The picture of a decoded painting.
[[nodiscard]] inline RgbPicture picture_of(const Film& film) { return {film.width, film.height, film.rgb}; }

/// Where a painting lies: the whole of it on the floor beside the reserve's columns, as large as fits, in the middle.
[[nodiscard]] PictureFloor lay_down(const Stage& stage, int width, int height);

/// Cells of which a tenth is grey in a painting, ascending; none unless its background repels. O(cells + pixels x
/// paints)
[[nodiscard]] std::vector<CellIndex> covered_cells(const Stage& stage, const RgbPicture& picture,
                                                   const PaintedOptions& options);

/// The show with the walls of its paintings among the stage's blocked cells: a wall stands all show long, so that the
/// planner, the judges and whoever reads the plan see it like any other; nothing where no painting has one.
[[nodiscard]] std::optional<Show> with_painted_walls(const Show& show, const std::vector<std::optional<Film>>& films);

}  // namespace footlight::planner
