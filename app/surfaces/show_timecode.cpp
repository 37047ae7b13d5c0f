// SPDX-License-Identifier: Apache-2.0
#include "app/surfaces/show_timecode.hpp"

namespace footlight::app {
namespace {

Duration day_of(FrameRate rate) { return time_of({23, 59, 59, frames_counted(rate) - 1, rate}) + frame_time(rate); }

}  // namespace

Duration in_show(Duration position, const TimeRules& rules) {
  const Duration day = day_of(rules.rate);
  const Duration out = position - rules.start;
  return out > day / 2 ? out - day : out < -day / 2 ? out + day : out;
}

std::string timecode_text(Duration time, FrameRate rate) {
  const Duration day = day_of(rate);
  time %= day;
  return to_text(code_at(time < Duration{} ? time + day : time, rate));
}

}  // namespace footlight::app
