// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/clock.hpp"
#include "core/result.hpp"
#include "core/show.hpp"
#include "core/timecode.hpp"

namespace footlight::app {

struct ShowState;  // app/live/cue_thread.hpp

/// What has come from a source of time since it was last asked.
struct TimeNews {
  std::vector<TimeFix> fixes;         ///< position in the show's time: 0 is count 1
  std::vector<std::string> alarms{};  ///< once each
  std::vector<std::string> notes{};
};

/// Where a show's time comes from, when it is not the machine's own clock. Asked again and again by one thread; does
/// not block. What has to be timed is timed where it comes in.
class TimeSource {
 public:
  virtual ~TimeSource() = default;
  /// "ltc tape.wav"
  [[nodiscard]] virtual std::string name() const = 0;
  /// @param now by the clock that it was opened with  @param show where the show is, for a source that goes with it
  virtual TimeNews read(Instant now, const ShowState& show) = 0;
  /// Becomes readable when there is something to read; -1: it has to be asked.
  [[nodiscard]] virtual int file() const { return -1; }
  /// Begins when the show does; else the source leads and says so.
  [[nodiscard]] virtual bool goes_with_the_show() const { return false; }
};

/// @param name what `footlight run --time` takes (kTimeSources)  @param folder that paths are relative to
/// @param clock borrowed, for what stamps by itself
/// Errors: ErrorKind::input for a name of no kind and for a file that is none, ErrorKind::device for what the machine
/// does not have.
[[nodiscard]] Result<std::unique_ptr<TimeSource>> open_time_source(const std::string& name,
                                                                   const std::filesystem::path& folder,
                                                                   const Show& show, const Clock& clock);

/// For people: every kind of name.
extern const char* const kTimeSources;

// Each kind.
[[nodiscard]] Result<std::unique_ptr<TimeSource>> open_audio(const std::string& what,
                                                             const std::filesystem::path& folder,
                                                             const TimeRules& rules, const Clock& clock);
[[nodiscard]] Result<std::unique_ptr<TimeSource>> open_ltc(const std::string& what, const std::filesystem::path& folder,
                                                           const TimeRules& rules);
[[nodiscard]] Result<std::unique_ptr<TimeSource>> open_mtc(const std::string& port, const TimeRules& rules,
                                                           const Clock& clock);
[[nodiscard]] Result<std::unique_ptr<TimeSource>> open_midi_clock(const std::string& port, const TempoMap& tempo,
                                                                  const Clock& clock);
[[nodiscard]] Result<std::unique_ptr<TimeSource>> open_osc_time(const std::string& address, const TimeRules& rules);

}  // namespace footlight::app
