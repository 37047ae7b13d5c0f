// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "planner/plan_section.hpp"

namespace footlight::planner {

/// One formation of the section's parts: each part's people on distinct cells as near to where it draws them as can be
/// had together, nobody on the reserve but who is in no part.
/// @param film a frame for each part that needs a picture, in their order; absent where none does
/// @return ErrorKind::input at the part: its group has too few people or nobody is left for it; it lies off the stage;
/// its people would stand nearer than the pitch and the clearance; blocked cells or parts before are in the way; or the
/// reserve is too small for who is in no part
[[nodiscard]] Result<SectionPlan> plan_parts(const Show& show, SectionIndex section, const std::optional<Film>& film,
                                             const Ways& ways);

}  // namespace footlight::planner
