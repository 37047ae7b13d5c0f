// SPDX-License-Identifier: Apache-2.0
#include "app/live/bare_timer.hpp"

namespace footlight::app {
namespace {

constexpr Duration kPeriod = milliseconds(10);

}  // namespace

BareTimer::BareTimer(const Clock& clock) : clock_(clock), waiting_(clock) {
  thread_ = std::thread([this] { run(); });
}

void BareTimer::stop() {
  if (!thread_.joinable()) return;
  stopping_.store(true, std::memory_order_relaxed);
  thread_.join();
}

void BareTimer::run() noexcept {
  (void)ask_for_real_time();
  Instant due = clock_.now() + kPeriod;
  while (!stopping_.load(std::memory_order_relaxed)) {
    waiting_.until(due);
    lateness_.add(clock_.now() - due);
    due = clock_.now() + kPeriod;
  }
}

}  // namespace footlight::app
