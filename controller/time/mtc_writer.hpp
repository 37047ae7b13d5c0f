// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "core/timecode.hpp"

namespace footlight::controller {

/// A place that goes on with the clock.
struct RunningTime {
  bool runs = false;
  Instant at{};         ///< it is at `position` then
  Duration position{};  ///< since 00:00:00:00; what lies before is of the day before
  double rate = 1;      ///< above 0 while it runs

  [[nodiscard]] Duration position_at(Instant now) const;
};

/// Says a time as MTC: quarter frames while it runs, a full frame where it stops, begins or jumps. Pure stepping. One
/// thread.
class MtcWriter {
 public:
  explicit MtcWriter(FrameRate rate) : rate_(rate) {}

  /// @return the message that is due now, again and again until there is none; valid until the next call
  std::span<const std::uint8_t> take(const RunningTime& time, Instant now);
  /// Clock time of the next message; kNever while the time stands.
  [[nodiscard]] Instant next_event(const RunningTime& time) const;

 private:
  [[nodiscard]] Duration quarter_at(std::int64_t quarter) const;
  std::span<const std::uint8_t> place(Duration position);

  FrameRate rate_;
  std::optional<std::int64_t> next_;  ///< number of the next quarter frame since 00:00:00:00, while it runs
  std::optional<Timecode> placed_;    ///< told while it stands
  std::array<std::uint8_t, 10> message_{};
};

}  // namespace footlight::controller
