// SPDX-License-Identifier: Apache-2.0
#include "controller/time/time_follower.hpp"

#include <algorithm>
#include <cmath>

namespace footlight::controller {
namespace {

constexpr std::size_t kToLock = 3;
constexpr Duration kShortestRun = milliseconds(80);
constexpr Duration kLongestStep = milliseconds(500);  // between two fixes of one run
constexpr Duration kWindow = milliseconds(1500);
constexpr Duration kSpeedKnown = milliseconds(300);  // a shorter line says nothing about the speed
constexpr Duration kSlack = milliseconds(40);        // of when a fix is seen
constexpr Duration kNear = milliseconds(60);         // of where it was followed to
constexpr double kOtherSpeed = 0.3;

Duration times(Duration duration, double factor) { return seconds(to_seconds(duration) * factor); }

}  // namespace

std::string_view to_text(TimeFollower::State state) {
  constexpr std::array<std::string_view, 4> kNames{"none", "locked", "freewheels", "lost"};
  return kNames.at(static_cast<std::size_t>(state));
}

bool TimeFollower::Run::continues(const TimeFix& fix) const noexcept {
  if (count == 0) return true;
  const Duration passed = fix.at - last().at;
  const Duration moved = fix.position - last().position;
  return passed >= Duration{} && passed <= kLongestStep && moved >= times(passed, kSlowest) - kSlack &&
         moved <= times(passed, kFastest) + kSlack;
}

std::optional<double> TimeFollower::Run::progress() const noexcept {
  if (count < kToLock) return std::nullopt;
  const TimeFix& first = fixes[(count - std::min(count, kKept)) % kKept];
  const Duration passed = last().at - first.at;
  if (passed < kShortestRun) return std::nullopt;
  return to_seconds(last().position - first.position) / to_seconds(passed);
}

/// The line through what was said in the last moments.
void TimeFollower::fit() noexcept {
  const TimeFix last = followed_.last();
  double n = 0;
  double t = 0;
  double p = 0;
  double tt = 0;
  double tp = 0;
  double first_s = 0;
  for (std::size_t i = 1; i <= std::min(followed_.count, kKept); ++i) {
    const TimeFix& fix = followed_.fixes[(followed_.count - i) % kKept];
    if (last.at - fix.at > kWindow) break;
    const double at_s = to_seconds(fix.at - last.at);
    const double position_s = to_seconds(fix.position - last.position);
    first_s = at_s;
    n += 1;
    t += at_s;
    p += position_s;
    tt += at_s * at_s;
    tp += at_s * position_s;
  }
  const double spread = tt - t * t / n;
  if (-first_s >= to_seconds(kSpeedKnown) && spread > 0)
    rate_ = std::clamp((tp - t * p / n) / spread, kSlowest, kFastest);
  mean_ = {last.at + seconds(t / n), last.position + seconds(p / n)};
}

void TimeFollower::take(const TimeFix& fix) noexcept {
  if (locked_ && fix.at >= followed_.last().at) {
    const Duration off = fix.position - *position(fix.at);
    if (off <= kNear && off >= -kNear) {
      // After a gap the speed is learned anew.
      if (!followed_.continues(fix)) followed_.count = 0;
      followed_.add(fix);
      other_.count = 0;
      return fit();
    }
  }
  if (!other_.continues(fix)) other_.count = 0;
  other_.add(fix);
  // What stands still is no source that could be followed.
  const auto progress = other_.progress();
  if (!progress || *progress < kSlowest || *progress > kFastest) return;
  jumps_ += locked_ ? 1 : 0;
  // So short a run tells a tape of another speed from one of the same, and no more.
  if (!locked_) rate_ = 1;
  if (std::abs(*progress - 1) > kOtherSpeed) rate_ = *progress;
  locked_ = true;
  followed_ = other_;
  other_.count = 0;
  fit();
}

TimeFollower::State TimeFollower::state(Instant now) const noexcept {
  if (!locked_) return State::none;
  const Duration silent = now - followed_.last().at;
  return silent <= kSilent ? State::locked : silent <= freewheel_ ? State::freewheels : State::lost;
}

std::optional<Duration> TimeFollower::position(Instant now) const noexcept {
  if (!locked_) return std::nullopt;
  return mean_.position + times(now - mean_.at, rate_);
}

}  // namespace footlight::controller
