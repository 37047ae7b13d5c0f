// SPDX-License-Identifier: Apache-2.0
#include "app/time/time_out.hpp"

#include <string_view>

#include <fmt/format.h>

namespace footlight::app {

controller::RunningTime running_time(const ShowState& show, const TimeRules& rules, Instant at) {
  controller::RunningTime time;
  time.runs = show.phase == controller::Rehearsal::Phase::runs && show.target.rate > 0;
  time.at = at;
  time.position = show.position.time_since_epoch() + rules.start;
  time.rate = show.target.rate;
  return time;
}

Result<std::unique_ptr<TimeOut>> TimeOut::open(const std::string& what, const TimeRules& rules) {
  constexpr std::string_view kMtc = "mtc:";
  constexpr std::string_view kOsc = "osc:";
  if (what.starts_with(kMtc) && what.size() > kMtc.size()) return open_mtc_out(what.substr(kMtc.size()), rules);
  if (what.starts_with(kOsc) && what.size() > kOsc.size()) return open_osc_time_out(what.substr(kOsc.size()), rules);
  return input_error(fmt::format("\"{}\" is nothing that time is sent to (mtc:PORT, osc:ADDRESS:PORT)", what));
}

}  // namespace footlight::app
