// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "planner/plan_section.hpp"

namespace footlight::planner {

/// Does to a section's formations what the director asks for (Li 2020 section IV C); those become key formations, and
/// give way as before where they are not exact. All of one override happens at once: a cell that is left may be taken.
/// @return ErrorKind::input, positioned: no such formation, nobody on the cell, the cell taken or not to be stood on,
/// nobody in the reserve or no room in it, somebody pinned twice
[[nodiscard]] std::optional<Error> apply_overrides(const Show& show, SectionIndex section, const Ways& ways,
                                                   SectionPlan& plan);

}  // namespace footlight::planner
