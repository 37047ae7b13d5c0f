// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "controller/cue_schedule.hpp"
#include "core/result.hpp"

namespace footlight::controller {

/// A schedule for markers that hold the look table of another one and show its looks: a look that both have keeps its
/// number, and a new one takes the number of a look that no lamp can be showing, or a number behind all others. So no
/// lamp changes while the new looks are uploaded, and none has to be lit again for the table's sake. Its plan byte is
/// not that of the other one, so that no latch takes what was preloaded for the other plan.
/// @param most looks that the devices of every bus know besides dark
/// @return ErrorKind::refused when the looks of both together are too many
[[nodiscard]] Result<CueSchedule> numbered_after(CueSchedule schedule, const CueSchedule& before, int most);

}  // namespace footlight::controller
