// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/film.hpp"
#include "core/index.hpp"
#include "core/plan.hpp"
#include "core/show.hpp"

namespace footlight::app {

/// One key formation from above as a PNG, downstage at the bottom as the audience sees it: cells with their letters and
/// numbers, wings shaded, blocked cells crossed out, everybody in the group's colour (those in the reserve small and
/// dim, those on the stage where the film shows nothing as rings), the walks to the next formation as thin lines, the
/// film's picture faintly below, what the marks mean, and a stamp of the plan.
/// @param film  of the formation's section, or null
[[nodiscard]] std::string formation_png(const Plan& plan, const Show& show, FormationIndex formation, const Film* film);

/// "012-growth-12.png": numbered in the order of the show, so that they sort.
[[nodiscard]] std::string picture_name(const Plan& plan, FormationIndex formation);

}  // namespace footlight::app
