// SPDX-License-Identifier: Apache-2.0
#include "app/rehearsing/tap_tempo.hpp"

namespace footlight::app {
namespace {

constexpr std::size_t kMostTaps = 8;
constexpr std::size_t kLeastTaps = 3;
constexpr Duration kPause = milliseconds(2500);  // slower than 24 counts a minute is nobody's tempo
constexpr Duration kBounce = milliseconds(150);

}  // namespace

std::optional<double> TapTempo::tap(Instant now) {
  if (!taps_.empty() && now - taps_.back() > kPause) taps_.clear();
  if (taps_.empty() || now - taps_.back() >= kBounce) taps_.push_back(now);
  if (taps_.size() > kMostTaps) taps_.erase(taps_.begin());
  if (taps_.size() < kLeastTaps) return std::nullopt;
  const auto n = static_cast<double>(taps_.size());
  const double middle = (n - 1) / 2;
  double along = 0;
  double squares = 0;
  for (std::size_t i = 0; i < taps_.size(); ++i) {
    const double x = static_cast<double>(i) - middle;
    along += x * to_seconds(taps_[i] - taps_.front());
    squares += x * x;
  }
  return 60 * squares / along;
}

}  // namespace footlight::app
