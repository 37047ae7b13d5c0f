// SPDX-License-Identifier: Apache-2.0
#include "core/clock.hpp"

#include <ctime>
#include <fstream>

#include "core/boot_time.hpp"
#include "core/check.hpp"
#include "core/machine_time.hpp"

namespace footlight {

SteadyClock::SteadyClock() : zero_(std::chrono::steady_clock::now()) {}

Instant SteadyClock::now() const {
  return Instant(std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now() - zero_));
}

Duration wall_time() {
  return std::chrono::duration_cast<Duration>(std::chrono::system_clock::now().time_since_epoch());
}

Duration machine_time() {
  return std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch());
}

std::string machine_start() {
  std::string id;
  std::getline(std::ifstream("/proc/sys/kernel/random/boot_id") >> std::ws, id);
  return id;
}

Duration boot_time() {
  timespec now{};
  (void)clock_gettime(CLOCK_BOOTTIME, &now);
  return std::chrono::seconds(now.tv_sec) + Duration(now.tv_nsec);
}

void ManualClock::advance_to(Instant instant) {
  FL_CHECK(instant >= now());
  now_.store(instant.time_since_epoch().count(), std::memory_order_release);
}

}  // namespace footlight
