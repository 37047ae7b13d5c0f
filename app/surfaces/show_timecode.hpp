// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/timecode.hpp"

namespace footlight::app {

/// The show's time of a position of the source. A pre-roll before 00:00:00:00 comes from the day before.
[[nodiscard]] Duration in_show(Duration position, const TimeRules& rules);

/// Before 00:00:00:00 the codes of the day before.
[[nodiscard]] std::string timecode_text(Duration time, FrameRate rate);

}  // namespace footlight::app
