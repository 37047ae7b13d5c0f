// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/time.hpp"

namespace footlight {

/// Frames a second of a timecode. 29.97 counts by drop-frame: minutes that are no multiple of ten begin with frame 2.
enum class FrameRate : std::uint8_t { fps24 = 0, fps25 = 1, fps2997_drop = 2, fps30 = 3 };  // as MTC numbers them
inline constexpr int kFrameRates = 4;
/// "24", "25", "29.97 drop-frame", "30"
[[nodiscard]] std::string_view to_text(FrameRate rate);
/// Numbers of a frame in a second: 24, 25, 30, 30.
[[nodiscard]] int frames_counted(FrameRate rate);
[[nodiscard]] Duration frame_time(FrameRate rate);

/// hh:mm:ss:ff
struct Timecode {
  int hours = 0;
  int minutes = 0;
  int seconds = 0;
  int frames = 0;
  FrameRate rate = FrameRate::fps25;

  friend bool operator==(const Timecode&, const Timecode&) = default;
};

/// Nothing that a clock of this rate would not show.
[[nodiscard]] bool valid(const Timecode& code);
/// Frames since 00:00:00:00. @param code valid
[[nodiscard]] std::int64_t frame_number(const Timecode& code);
/// The code of a frame; after a day it begins again. @param frame from 0
[[nodiscard]] Timecode code_of(std::int64_t frame, FrameRate rate);
/// Time since 00:00:00:00, in seconds that pass: a frame of 29.97 is 1001/30000 s. @param code valid
[[nodiscard]] Duration time_of(const Timecode& code);
/// The last code that has begun so long after 00:00:00:00. @param time from 0
[[nodiscard]] Timecode code_at(Duration time, FrameRate rate);
/// "01:02:03:04", with ";" before the frames of drop-frame.
[[nodiscard]] std::string to_text(const Timecode& code);
/// The inverse, for one rate; "." and "," may stand before the frames, too. Nothing: no timecode of this rate.
[[nodiscard]] std::optional<Timecode> parse_timecode(std::string_view text, FrameRate rate);

/// A source of time has said where it is.
struct TimeFix {
  Instant at;         ///< by the clock
  Duration position;  ///< of the source, since its 00:00:00:00
};

/// What the show does when its source of time is lost.
enum class TimeLoss : std::uint8_t {
  go_on,      ///< by its own clock
  next_hold,  ///< to where everybody next stands, and waits there
  hold,       ///< at once, in the middle of a walk if need be
};

/// A show's written rules for a source of time.
struct TimeRules {
  std::string source{};               ///< as `footlight run --time`; empty: the machine's own clock
  Duration start{};                   ///< of the source, at count 1
  FrameRate rate = FrameRate::fps25;  ///< that LTC is taken for until it tells, and in which positions are written
  TimeLoss lost = TimeLoss::next_hold;
  Duration freewheel = milliseconds(2000);  ///< silence until the source counts as lost
};

}  // namespace footlight
