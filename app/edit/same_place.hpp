// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "controller/cue_list.hpp"
#include "controller/stands.hpp"
#include "core/plan.hpp"

namespace footlight::app {

/// Where a show that stands here stands in another plan of it: at the beginning of the same standby cue; in a cue that
/// is held as far into the same section, or the last place before it at which everybody stands. A cue or section that
/// is gone is replaced by what comes before it.
/// @param active, standby cue as `ShowState` has them, -1: none
[[nodiscard]] Instant same_place(const Plan& before, const std::vector<controller::CuePlay>& plays_before,
                                 const Plan& now, const std::vector<controller::CuePlay>& plays,
                                 const controller::Stands& stands, Instant position, int active, int standby);

}  // namespace footlight::app
