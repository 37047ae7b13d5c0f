// SPDX-License-Identifier: Apache-2.0
#include "controller/cue_engine.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "core/check.hpp"

namespace footlight::controller {

std::string_view to_text(CueState state) {
  constexpr std::array<std::string_view, 5> kNames{"stopped", "pre-wait", "running", "post-wait", "done"};
  return kNames.at(static_cast<std::size_t>(state));
}

CueEngine::CueEngine(const CueSchedule& schedule, std::vector<CuePlay> plays, std::vector<Duration> notices)
    : schedule_(schedule), plays_(std::move(plays)), notices_(std::move(notices)) {
  FL_CHECK(!plays_.empty() && notices_.size() == plays_.size());
}

GoAnswer CueEngine::go(Instant now) noexcept {
  step(now);
  if (active_) return GoAnswer::running;
  if (next_cue_ == plays_.size()) return GoAnswer::nothing_left;
  begin(next_cue_, now + std::max(plays_[next_cue_].cue.pre_wait, notices_[next_cue_]));
  step(now);
  return GoAnswer::started;
}

void CueEngine::begin(std::size_t cue, Instant at) noexcept {
  active_ = cue;
  next_cue_ = cue + 1;
  begins_at_ = at;
}

void CueEngine::step(Instant now) noexcept {
  now_ = now;
  while (true) {
    while (lit_ + 1 < schedule_.switches().size() && due(lit_ + 1) <= now) ++lit_;
    if (!active_ || now < ends_at()) return;
    const std::optional<Duration> gap = plays_[*active_].gap_after;
    if (!gap || next_cue_ == plays_.size()) {
      active_.reset();
      return;
    }
    begin(next_cue_, ends_at() + *gap);
  }
}

Instant CueEngine::ends_at() const noexcept { return begins_at_ + (plays_[*active_].to - plays_[*active_].from); }

Instant CueEngine::due(std::size_t k) const noexcept {
  if (!active_ || k >= schedule_.switches().size()) return kNever;
  const Switch& due = schedule_.switches()[k];
  if (!due.cue) return kNever;
  if (*due.cue == *active_) return begins_at_ + (due.time - plays_[*active_].from);
  const std::optional<Duration> gap = plays_[*active_].gap_after;
  if (*due.cue != *active_ + 1 || !gap) return kNever;
  return ends_at() + *gap + (due.time - plays_[*due.cue].from);
}

BusTarget CueEngine::target() const noexcept {
  BusTarget target;
  target.current = lit_;
  target.next = std::min(lit_ + 1, schedule_.switches().size() - 1);
  target.next_at = target.next == lit_ ? kNever : due(target.next);
  target.show_time = position().time_since_epoch();
  return target;
}

Instant CueEngine::next_event() const noexcept {
  if (!active_) return kNever;
  Instant earliest = std::min(due(lit_ + 1), ends_at());
  if (begins_at_ > now_) earliest = std::min(earliest, begins_at_);
  return earliest;
}

Instant CueEngine::position() const noexcept {
  if (!active_) return next_cue_ == 0 ? plays_.front().from : plays_[next_cue_ - 1].to;
  const CuePlay& play = plays_[*active_];
  return std::clamp(play.from + (now_ - begins_at_), play.from, play.to);
}

CueState CueEngine::state(std::size_t cue) const noexcept {
  if (active_ && cue == *active_) return now_ < begins_at_ ? CueState::pre_wait : CueState::running;
  if (active_ && cue + 1 == *active_ && now_ < begins_at_ - plays_[*active_].cue.pre_wait &&
      plays_[cue].cue.continue_mode != ContinueMode::manual) {
    return CueState::post_wait;
  }
  return cue < next_cue_ ? CueState::done : CueState::stopped;
}

std::optional<std::size_t> CueEngine::standby() const noexcept {
  if (next_cue_ == plays_.size()) return std::nullopt;
  return next_cue_;
}

}  // namespace footlight::controller
