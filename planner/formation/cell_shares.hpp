// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/film.hpp"
#include "core/grid.hpp"
#include "core/plan.hpp"

namespace footlight::planner {

/// Pixels that belong to the picture. O(pixels / 64)
[[nodiscard]] std::int64_t picture_area(const Mask& mask);

/// Share of picture, 0..1 in millionths, in the square of one cell's area around each cell's centre (r_pa of Li 2020
/// section III C, measured as rho of Eq. 8 is). One value a cell.
///
/// One pass over the frame's words: for each line of cells the pixel rows that it covers are added up column by column
/// in binary counters of one word a digit and 64 pixels, a cell's sum is then the difference of two counts of bits.
/// Rows and columns that a square covers in part count in part. The map scales both axes alike; one that turns the
/// picture takes a summed-area table. O(pixels / 64 + cells with picture), the same bits on every processor.
[[nodiscard]] std::vector<double> cell_shares(const Mask& mask, const Grid& grid, const StageToFrame& map);

}  // namespace footlight::planner
