// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/film.hpp"
#include "planner/plan_section.hpp"

namespace footlight::planner {

/// The formations of a section that comes from a video or an image.
/// @param film with at least one frame  @return as `plan_section`
[[nodiscard]] Result<SectionPlan> plan_pictures(const Show& show, SectionIndex section, const Film& film,
                                                const Ways& ways, const Station* before, const Progress& progress);

}  // namespace footlight::planner
