// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "app/paper/canvas.hpp"
#include "app/paper/paper_size.hpp"
#include "app/paper/stamp.hpp"
#include "core/plan.hpp"
#include "core/rig.hpp"
#include "core/show.hpp"

namespace footlight::app {

/// A key formation of the whole stage with everybody's name in the own cell, so large that names can be read: on as
/// many pages as that takes, to be glued together ("A1" is downstage, stage right), after a page that shows how. Where
/// a name does not fit into a cell, the id is there. @param canvas a PDF of this paper's size, on a fresh page
void draw_chart(Canvas& canvas, const PaperSize& paper, const Stamp& stamp, const Plan& plan, const Show& show,
                FormationIndex formation);

/// The grid for laying out markers: the name of every cell, and bus, node and channel of its lamp, on pages as above.
void draw_floor_plan(Canvas& canvas, const PaperSize& paper, const Stamp& stamp, const Plan& plan, const Rig& rig);

}  // namespace footlight::app
