// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>

namespace footlight {

/// All time is integer nanoseconds; doubles appear only where people read or write seconds.
using Duration = std::chrono::nanoseconds;

/// The line on which instants lie. Position 0 of a show is count 1; a clock's zero is its own affair.
struct Timeline {
  using rep = Duration::rep;
  using period = Duration::period;
  using duration = Duration;
};
using Instant = std::chrono::time_point<Timeline, Duration>;

inline constexpr Instant kStart{};
inline constexpr Instant kNever = Instant::max();

/// Nearest nanosecond. @param value s, |value| < 9e9
[[nodiscard]] inline Duration seconds(double value) { return Duration(std::llround(value * 1e9)); }
[[nodiscard]] inline Instant instant_at(double value_s) { return Instant(seconds(value_s)); }
[[nodiscard]] inline double to_seconds(Duration duration) { return static_cast<double>(duration.count()) / 1e9; }
[[nodiscard]] inline double to_seconds(Instant instant) { return to_seconds(instant.time_since_epoch()); }
[[nodiscard]] constexpr Duration milliseconds(std::int64_t value) { return Duration(value * 1'000'000); }
[[nodiscard]] constexpr Duration microseconds(std::int64_t value) { return Duration(value * 1'000); }

}  // namespace footlight
