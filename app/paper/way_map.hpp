// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/paper/canvas.hpp"
#include "app/paper/part.hpp"
#include "core/grid.hpp"

namespace footlight::app {

/// One place of a part on paper, downstage below: where the performer came from, is, and goes to. As large as the way.
/// @param i  the place's number in the part  @param colour  of the performer
void draw_way_map(Canvas& canvas, Point corner, double size, const Grid& grid, const Part& part, std::size_t i,
                  Ink colour);

/// The way through the whole show on the whole floor, at the right edge of the box.
void draw_floor_map(Canvas& canvas, Point corner, double width, double height, const Grid& grid, const Part& part,
                    Ink colour);

}  // namespace footlight::app
