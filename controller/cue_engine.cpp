// SPDX-License-Identifier: Apache-2.0
#include "controller/cue_engine.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "core/check.hpp"

namespace footlight::controller {
namespace {

constexpr Duration::rep kMillion = 1'000'000;
constexpr int kPpmAPercent = 10'000;

/// Show time that passes in so much time of the clock, rounded down. Exact integers: the position reaches a switch in
/// the very nanosecond in which the switch is due.
Duration show_time_in(Duration clock, Duration::rep ppm) {
  const Duration::rep whole = clock.count() / kMillion;
  return Duration(whole * ppm + (clock.count() - whole * kMillion) * ppm / kMillion);
}

/// Clock time until so much show time has passed, rounded up: the inverse of the above.
Duration clock_time_for(Duration show, Duration::rep ppm) {
  const Duration::rep whole = show.count() / ppm;
  return Duration(whole * kMillion + ((show.count() - whole * ppm) * kMillion + ppm - 1) / ppm);
}

}  // namespace

std::string_view to_text(CueState state) {
  constexpr std::array<std::string_view, 6> kNames{"stopped", "pre-wait", "running", "paused", "post-wait", "done"};
  return kNames.at(static_cast<std::size_t>(state));
}

std::size_t lit_at(const CueSchedule& schedule, Instant position, bool waits) {
  const auto& switches = schedule.switches();
  const bool before = waits && position < switches.back().time;
  const auto after = std::ranges::partition_point(switches, [&](const Switch& one) {
    return one.time < position || (one.time == position && (one.settled || !before));
  });
  return after == switches.begin() ? 0 : static_cast<std::size_t>(after - switches.begin()) - 1;
}

CueEngine::CueEngine(const CueSchedule& schedule, std::vector<CuePlay> plays, std::vector<Duration> notices)
    : schedule_(schedule),
      plays_(std::move(plays)),
      notices_(std::move(notices)),
      limits_(plays_.size(), kFastest_percent) {
  FL_CHECK(!plays_.empty() && notices_.size() == plays_.size());
}

void CueEngine::set_limits(std::vector<int> percent) {
  FL_CHECK(percent.size() == plays_.size());
  for (std::size_t c = 0; c < percent.size(); ++c) {
    limits_[c] = std::clamp(percent[c], kSlowest_percent, kFastest_percent);
  }
}

GoAnswer CueEngine::go(Instant now, Duration lead) noexcept {
  step(now);
  if (active_) return GoAnswer::running;
  if (next_cue_ == plays_.size()) return GoAnswer::nothing_left;
  begin(next_cue_, now + std::max(plays_[next_cue_].cue.pre_wait + lead, notices_[next_cue_]));
  step(now);
  return GoAnswer::started;
}

GoAnswer CueEngine::start(Instant now, Instant at) noexcept {
  step(now);
  if (active_) return GoAnswer::running;
  if (next_cue_ == plays_.size()) return GoAnswer::nothing_left;
  begin(next_cue_, std::max(at, now + notices_[next_cue_]));
  step(now);
  return GoAnswer::started;
}

void CueEngine::move_start(Instant now, Instant at) noexcept {
  step(now);
  if (active_ && !frozen_ && now < anchor_at_) anchor_at_ = std::max(at, now);
}

void CueEngine::begin(std::size_t cue, Instant at) noexcept {
  active_ = cue;
  next_cue_ = cue + 1;
  anchor_at_ = at;
  anchor_ = plays_[cue].from;
  frozen_ = false;
  before_ = true;
}

void CueEngine::freeze_at(Instant position, bool before) noexcept {
  stop_.reset();
  anchor_ = position;
  frozen_ = true;
  before_ = before;
}

bool CueEngine::freeze(Instant now) noexcept {
  step(now);
  if (!active_ || frozen_) return false;
  stop_.reset();
  if (before_ && anchor_ == plays_[*active_].from) {
    next_cue_ = *active_;  // it has not begun
    active_.reset();
  } else {
    freeze_at(position(), before_);
  }
  return true;
}

bool CueEngine::resume(Instant now, Instant at) noexcept {
  step(now);
  if (!active_ || !frozen_) return false;
  anchor_at_ = at;
  frozen_ = false;
  step(now);
  return true;
}

void CueEngine::place(Instant position) noexcept {
  FL_CHECK(!active_ || frozen_);
  active_.reset();
  stop_.reset();
  next_cue_ = 0;
  while (next_cue_ < plays_.size() && plays_[next_cue_].to <= position) ++next_cue_;
  if (next_cue_ < plays_.size() && position > plays_[next_cue_].from) {
    active_ = next_cue_++;
    freeze_at(position, true);
  }
  lit_ = lit_at(schedule_, this->position(), true);
}

void CueEngine::take_up(std::size_t cue, Instant position, bool before, std::optional<Instant> runs_since) noexcept {
  FL_CHECK(!active_ && cue < plays_.size());
  begin(cue, runs_since.value_or(now_));
  anchor_ = std::clamp(position, plays_[cue].from, plays_[cue].to);
  before_ = before;
  frozen_ = !runs_since;
  now_ = std::min(now_, anchor_at_);  // what has happened since comes with the next step
  lit_ = lit_at(schedule_, anchor_, before);
}

void CueEngine::set_tempo(Instant now, int percent) noexcept {
  step(now);
  const Instant here = position();
  wanted_percent_ = std::clamp(percent, kSlowest_percent, kFastest_percent);
  anchor_here(here);
}

void CueEngine::lead(Instant now, std::optional<int> ppm) noexcept {
  if (ppm == led_ppm_) return;
  step(now);
  const Instant here = position();
  led_ppm_ = ppm;
  anchor_here(here);
}

/// What the speed was until now stays as it was.
void CueEngine::anchor_here(Instant here) noexcept {
  if (!active_ || frozen_ || now_ <= anchor_at_) return;
  anchor_at_ = now_;
  anchor_ = here;
}

void CueEngine::make_up(Instant now, Duration ahead) noexcept {
  step(now);
  if (!active_ || frozen_ || now < anchor_at_) return;
  // Whatever it passes on the way is behind it by the step that follows: only where it gets to is shown.
  anchor_ = std::min(position() + ahead, plays_[*active_].to);
  anchor_at_ = now;
  step(now);
}

void CueEngine::step(Instant now) noexcept {
  now_ = now;
  while (true) {
    while (lit_ + 1 < schedule_.switches().size() && due(lit_ + 1) <= now) ++lit_;
    if (!active_ || frozen_) return;
    before_ = before_ && now < anchor_at_;
    const bool stops = stop_ && *stop_ < plays_[*active_].to;
    if (stops && clock_at(*stop_) <= now) return freeze_at(*stop_, true);
    if (now < ends_at()) return;
    const std::optional<Duration> gap = gap_after(*active_);
    if (!gap || next_cue_ == plays_.size() || (stop_ && *stop_ == plays_[*active_].to)) {
      active_.reset();
      stop_.reset();
      return;
    }
    begin(next_cue_, ends_at() + *gap);
  }
}

Instant CueEngine::clock_at(Instant position) const noexcept {
  if (!active_ || frozen_) return kNever;
  return anchor_at_ + clock_time_for(std::max(Duration{}, position - anchor_), speed_ppm(*active_));
}

Instant CueEngine::ends_at() const noexcept { return clock_at(plays_[*active_].to); }

Instant CueEngine::due(std::size_t k) const noexcept {
  if (!active_ || frozen_ || k >= schedule_.switches().size()) return kNever;
  const Switch& due = schedule_.switches()[k];
  if (!due.cue || (stop_ && (due.time > *stop_ || (due.time == *stop_ && !due.settled)))) return kNever;
  if (*due.cue == *active_) return clock_at(due.time);
  const std::optional<Duration> gap = gap_after(*active_);
  if (*due.cue != *active_ + 1 || !gap) return kNever;
  return ends_at() + *gap + clock_time_for(due.time - plays_[*due.cue].from, speed_ppm(*due.cue));
}

BusTarget CueEngine::target() const noexcept {
  BusTarget target;
  target.current = lit_;
  target.next = std::min(lit_ + 1, schedule_.switches().size() - 1);
  target.next_at = target.next == lit_ ? kNever : due(target.next);
  target.show_time = position().time_since_epoch();
  target.rate = static_cast<double>(speed_ppm(cue_of_tempo())) / kMillion;
  return target;
}

Instant CueEngine::next_event() const noexcept {
  if (!active_ || frozen_) return kNever;
  Instant earliest = std::min(due(lit_ + 1), ends_at());
  if (stop_) earliest = std::min(earliest, clock_at(*stop_));
  if (anchor_at_ > now_) earliest = std::min(earliest, anchor_at_);
  return earliest;
}

Instant CueEngine::position() const noexcept {
  if (!active_) return next_cue_ == 0 ? plays_.front().from : plays_[next_cue_ - 1].to;
  if (frozen_ || now_ <= anchor_at_) return anchor_;
  return std::min(anchor_ + show_time_in(now_ - anchor_at_, speed_ppm(*active_)), plays_[*active_].to);
}

bool CueEngine::waits() const noexcept { return !active_ || before_; }

int CueEngine::percent_of(std::size_t cue) const noexcept { return std::min(wanted_percent_, limits_[cue]); }

Duration::rep CueEngine::speed_ppm(std::size_t cue) const noexcept {
  if (!led_ppm_) return Duration::rep{kPpmAPercent} * percent_of(cue);
  return std::clamp(*led_ppm_, kPpmAPercent * kSlowest_percent, kPpmAPercent * limits_[cue]);
}

std::optional<Duration> CueEngine::gap_after(std::size_t cue) const noexcept {
  return led_ppm_ ? Duration{} : plays_[cue].gap_after;
}

std::size_t CueEngine::cue_of_tempo() const noexcept {
  return active_.value_or(std::min(next_cue_, plays_.size() - 1));
}

int CueEngine::percent() const noexcept {
  return static_cast<int>((speed_ppm(cue_of_tempo()) + kPpmAPercent / 2) / kPpmAPercent);
}

int CueEngine::limit_percent() const noexcept { return limits_[cue_of_tempo()]; }

CueState CueEngine::state(std::size_t cue) const noexcept {
  if (active_ && cue == *active_) {
    if (frozen_) return CueState::paused;
    return now_ < anchor_at_ ? CueState::pre_wait : CueState::running;
  }
  if (active_ && cue + 1 == *active_ && !frozen_ && now_ < anchor_at_ - plays_[*active_].cue.pre_wait &&
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
