// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "app/surfaces/run_desk.hpp"
#include "controller/time/mtc_writer.hpp"
#include "core/clock.hpp"
#include "core/result.hpp"
#include "core/show.hpp"

namespace footlight::app {

/// Footlight as master of time: says where the show is. What it says is as old as the last look.
class TimeOut : public Surface {
 public:
  /// @param what "mtc:PORT", "osc:ADDRESS:PORT"  @param rules `start` is what is said at count 1, `frame_rate` how
  /// Errors: ErrorKind::input for no such kind, ErrorKind::device: the port is not to be had.
  [[nodiscard]] static Result<std::unique_ptr<TimeOut>> open(const std::string& what, const TimeRules& rules);

  /// Before the run. @param run the clock of its views; borrowed
  void use(const Clock& run) { run_ = &run; }
  [[nodiscard]] bool listens() const override { return false; }

 protected:
  const Clock* run_ = nullptr;
};

/// Where the show is, for others. @param at when `show` was so, by the clock in which it is to be told
[[nodiscard]] controller::RunningTime running_time(const ShowState& show, const TimeRules& rules, Instant at);

// Each kind. MIDI Time Code: quarter frames by a thread of its own. OSC over UDP: 25 times a second /footlight/time
// (seconds), /footlight/timecode (text), /footlight/runs (1, 0), in one bundle.
[[nodiscard]] Result<std::unique_ptr<TimeOut>> open_mtc_out(const std::string& port, const TimeRules& rules);
[[nodiscard]] Result<std::unique_ptr<TimeOut>> open_osc_time_out(const std::string& address, const TimeRules& rules);

}  // namespace footlight::app
