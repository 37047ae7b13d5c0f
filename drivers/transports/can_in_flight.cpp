// SPDX-License-Identifier: Apache-2.0
#include "drivers/transports/can_in_flight.hpp"

#include <algorithm>

#include "core/check.hpp"

namespace footlight::drivers {
namespace {

constexpr Duration kLostAfter = milliseconds(1000);
constexpr Duration kShortestStall = milliseconds(70);
constexpr Duration::rep kLongestWaitBits = Duration::rep{190} * 135;

}  // namespace

Duration can_stall_time(int bits_per_second) {
  FL_CHECK(bits_per_second > 0);
  return std::max(kShortestStall, Duration(kLongestWaitBits * 1'000'000'000 / bits_per_second));
}

void CanInFlight::accepted(const CanFrame& frame, Instant now) {
  if (waiting_.empty()) progress_ = now;
  waiting_.push_back({frame, now});
  full_since_.reset();
}

void CanInFlight::refused(Instant now) {
  if (!full_since_) full_since_ = now;
}

void CanInFlight::forget() {
  waiting_.clear();
  full_since_.reset();
}

bool CanInFlight::stalled(Instant now) const {
  if (full_since_ && now >= *full_since_ + stall_time_) return true;
  return !waiting_.empty() && now >= progress_ + stall_time_;
}

void CanInFlight::echoed(const CanFrame& frame, Instant now) {
  const auto same = [&](const Waiting& waiting) { return waiting.frame == frame; };
  const auto found = std::find_if(waiting_.begin(), waiting_.end(), same);
  if (found == waiting_.end()) return;
  waiting_.erase(found);
  progress_ = now;
  while (!waiting_.empty() && now - waiting_.front().since > kLostAfter) waiting_.pop_front();
}

}  // namespace footlight::drivers
