// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/show.hpp"
#include "planner/painted/scene.hpp"

namespace footlight::app {

/// What was understood of a painting, a line for each group, each of its shapes and strokes, and the walls.
/// @param file where it was drawn, or empty
[[nodiscard]] std::string painting_text(const Show& show, SectionIndex section, const planner::PaintedScene& scene,
                                        const std::string& file);

/// {"section", "painting": {"file", "width", "height", "pixel_m"}, "parties": [{"group", "people", "shapes": [{"order",
/// "area_m2"}], "legs": [{"from", "to", "strokes": [{"length_m", "width_m", "fall", "tail", "head", "line"}]}]}],
/// "blocked_cells", "warnings", "files"}; places are [x, y] in metres, a line's from tail to head [x, y, width].
[[nodiscard]] std::string painting_json(const Show& show, SectionIndex section, const planner::PaintedScene& scene,
                                        const std::string& file);

}  // namespace footlight::app
