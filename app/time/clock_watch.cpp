// SPDX-License-Identifier: Apache-2.0
#include "app/time/clock_watch.hpp"

#include <utility>

namespace footlight::app {

std::optional<ClockWatch::News> ClockWatch::take(Instant steady, Duration boot, Duration wall) {
  const Duration asleep = boot - steady.time_since_epoch();
  const Duration wall_ahead = wall - boot;  // a sleep is no step
  const auto asleep_before = std::exchange(asleep_, asleep);
  const auto wall_before = std::exchange(wall_ahead_, wall_ahead);
  if (!asleep_before) return std::nullopt;
  if (asleep - *asleep_before > kSlept) return News{Kind::slept, asleep - *asleep_before};
  const Duration step = wall_ahead - *wall_before;
  if (step > kStepped || step < -kStepped) return News{Kind::stepped, step};
  return std::nullopt;
}

}  // namespace footlight::app
