// SPDX-License-Identifier: Apache-2.0
#include "app/remote/flood_guard.hpp"

namespace footlight::app {

void FloodGuard::roll(Instant now) {
  if (window_ != Instant::min() && now - window_ < kWindow) return;
  window_ = now;
  taken_.clear();
  of_all_ = 0;
}

bool FloodGuard::full(std::string_view client, Instant now) {
  roll(now);
  const auto taken = taken_.find(client);
  return of_all_ >= kMostOfAll || (taken != taken_.end() && taken->second >= kMost);
}

bool FloodGuard::take(std::string_view client, Instant now) {
  if (full(client, now)) {
    lose(now);
    return false;
  }
  ++taken_[std::string(client)];
  ++of_all_;
  held_ = false;
  return true;
}

bool FloodGuard::take_hold(Instant now) {
  if (!std::exchange(held_, true)) return true;
  flood_at_ = now;
  return false;
}

void FloodGuard::lose(Instant now) {
  ++lost_;
  flood_at_ = now;
}

}  // namespace footlight::app
