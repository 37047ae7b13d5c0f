// SPDX-License-Identifier: Apache-2.0
#include "controller/time/chase.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace footlight::controller {
namespace {

using Phase = Rehearsal::Phase;
using State = TimeFollower::State;

constexpr double kMostSlew = 0.10;
constexpr double kMakeUp_s = 1.0;     // what is off is made up for in about so long
constexpr int kSameSpeed_ppm = 1000;  // smaller changes of the speed are left
constexpr double kTooFast = 0.005;    // beyond the limit, before it is told
constexpr double kMillion = 1e6;
constexpr Duration kRetimed = milliseconds(1000);  // a start is not moved any more when it is so near
constexpr Duration kOnTime = milliseconds(4);

bool within(Duration off, Duration most) { return off <= most && off >= -most; }

}  // namespace

std::string_view to_text(TimeAlarm alarm) {
  constexpr std::array<std::string_view, 6> kNames{"", "follows", "freewheels", "lost", "jumped", "too-fast"};
  return kNames.at(static_cast<std::size_t>(alarm));
}

Chase::Chase(Rehearsal& rehearsal, TimeRules rules)
    : rehearsal_(&rehearsal), rules_(std::move(rules)), follower_(rules_.freewheel) {}

void Chase::take_up(const Word& word) noexcept {
  view_.on = word.on;
  view_.armed = word.armed;
}

void Chase::carry_on(Rehearsal& rehearsal, Instant now) noexcept {
  let_go(now);
  rehearsal_ = &rehearsal;
}

void Chase::tell(TimeAlarm alarm) noexcept {
  view_.alarm = alarm;
  view_.alarm_off = view_.off;
  ++view_.alarms;
}

void Chase::say(Command::Kind kind, Instant position, Instant now) noexcept {
  Command command;
  command.kind = kind;
  command.source = GoSource::clock;
  command.position = position;
  (void)rehearsal_->apply(command, now);
}

bool Chase::runs() const noexcept {
  const Phase phase = rehearsal_->phase();
  return phase == Phase::runs || phase == Phase::counts_in;
}

// ---- orders

void Chase::hear(const Command& fix) noexcept {
  view_.there = true;
  follower_.take({fix.at, fix.position.time_since_epoch()});
}

Outcome Chase::take(const Command& command, Instant now) noexcept {
  using Kind = Command::Kind;
  switch (command.kind) {
    case Kind::follow:
      if (!view_.there) return Outcome::no_source;
      view_.on = view_.armed = true;
      return Outcome::done;
    case Kind::unfollow:
      if (!view_.there) return Outcome::no_source;
      view_.on = false;
      let_go(now);
      return Outcome::done;
    case Kind::join:
      return join(now);
    default:
      break;
  }
  // A hold of what stands holds nothing, but whoever says it wants nothing to begin.
  if (command.kind == Kind::hold || command.kind == Kind::hold_at_end) view_.armed = false;
  const Outcome outcome = rehearsal_->apply(command, now);
  if (refused(outcome)) return outcome;
  if (command.kind == Kind::go) view_.armed = true;
  // By hand: the source leads no more where it has only been lost.
  if (command.kind == Kind::tempo && leads_ && !view_.follows) let_go(now);
  return outcome;
}

Outcome Chase::join(Instant now) noexcept {
  const auto source = follower_.position(now);
  const Instant end = engine().plays().back().to;
  if (!source || follower_.state(now) != State::locked || Instant(*source) >= end) return Outcome::no_source;
  let_go(now);
  Command command;
  command.kind = Command::Kind::jump;
  command.position = stands().from(std::max(Instant(*source), engine().plays().front().from), true);
  const Outcome outcome = rehearsal_->apply(command, now);
  if (!refused(outcome)) view_.on = view_.armed = true;
  return outcome;
}

// ---- time

void Chase::step(Instant now) noexcept {
  if (!view_.there) return;
  const auto position = follower_.position(now);
  view_.state = follower_.state(now);
  view_.rate = follower_.rate();
  if (!position) return;
  const Instant source(*position);
  view_.source = source;
  view_.off = source - engine().position();
  if ((leads_ || view_.follows) && !runs() && !waits_) let_go(now);
  // What a gate or a hold button has stopped goes on by somebody's word, not by itself.
  if ((rehearsal_->barred() & kHolding) != 0) view_.armed = false;
  if (!view_.on) return;
  const Phase phase = rehearsal_->phase();
  if (phase == Phase::stands && view_.state == State::locked) begin(source, now);
  if (phase == Phase::stands && view_.follows && view_.state == State::lost) {
    tell(TimeAlarm::lost);  // while it waited for the source
    let_go(now);
  }
  if (phase == Phase::counts_in && view_.follows && view_.state != State::freewheels) {
    // What was to begin begins only if the source still comes.
    const Duration left = rehearsal_->goes_at() - now;
    const Duration late = view_.off + seconds(to_seconds(left) * view_.rate);
    if (view_.state != State::locked || !within(late, kStepped)) {
      say(Command::Kind::hold, {}, now);
      tell(view_.state == State::locked ? TimeAlarm::jumped : TimeAlarm::lost);
      let_go(now);
    } else if (left > kRetimed && !within(late, kOnTime)) {
      rehearsal_->move_start(now, rehearsal_->goes_at() - late);
    }
  }
  if (phase == Phase::runs) follow(source, now);
}

/// What stands goes on when the source passes it.
void Chase::begin(Instant source, Instant now) noexcept {
  const Instant here = engine().position();
  const bool everybody_stands = stands().from(here, engine().waits()) == here;
  if (!view_.armed || !everybody_stands || rehearsal_->barred() != 0 ||
      rehearsal_->reset().state != Rehearsal::ResetState::none)
    return;
  const Duration left = seconds(to_seconds(here - source) / view_.rate);
  if (left > kAhead || source - here > kStepped) return;
  const bool waited = std::exchange(waits_, false);
  lead(now, view_.rate);
  if (refused(rehearsal_->start(now, now + std::max(left, Duration{})))) return let_go(now);
  if (!std::exchange(view_.follows, true) && !waited) tell(TimeAlarm::follows);
}

void Chase::follow(Instant source, Instant now) noexcept {
  const Duration off = view_.off;
  if (!view_.follows) {
    if (view_.state != State::locked || !within(off, kStepped)) return;
    view_.follows = true;
    tell(TimeAlarm::follows);
  }
  if (view_.state == State::lost) return lose(now);
  if (view_.state == State::freewheels) {
    if (!std::exchange(silent_, true)) tell(TimeAlarm::freewheels);
    return;
  }
  const bool was_silent = std::exchange(silent_, false);
  if (!within(off, kStepped)) return hold_for_jump(source, now);
  if (was_silent) tell(TimeAlarm::follows);
  const bool fast = view_.rate > engine().limit_percent() / 100.0 + kTooFast;
  if (fast && !fast_) tell(TimeAlarm::too_fast);
  fast_ = fast;
  if (within(off, kSlewed)) {
    step_from_.reset();
    if (std::exchange(waits_, false)) say(Command::Kind::run_on, {}, now);
    return lead(now, view_.rate * (1 + std::clamp(to_seconds(off) / kMakeUp_s, -kMostSlew, kMostSlew)));
  }
  if (waits_) return;
  lead(now, view_.rate);
  if (off > Duration{}) return step_ahead(engine().position(), off, now);
  // It waits there for the source, and goes on as what stands does.
  waits_ = true;
  say(Command::Kind::hold_at_end, {}, now);
}

void Chase::step_ahead(Instant here, Duration off, Instant now) noexcept {
  if (!step_from_) step_from_ = stands().from(here, false);
  if (here < *step_from_) return;
  const auto rest = stands().rest(*step_from_);
  step_from_.reset();
  if (rest) {
    const double speed = view_.rate * 100 / engine().limit_percent();
    off = std::min(off, rest->stands + seconds(to_seconds(rest->shortest_walk) * std::max(0.0, 1 - speed)));
  }
  rehearsal_->make_up(now, off);
}

void Chase::hold_for_jump(Instant source, Instant now) noexcept {
  tell(TimeAlarm::jumped);
  const auto& plays = engine().plays();
  const Instant here = engine().position();
  const Instant stand = stands().from(here, engine().waits());
  const Instant to = stands().from(std::max(source, plays.front().from), true);
  let_go(now);
  if (rules_.lost == TimeLoss::hold) say(Command::Kind::hold, {}, now);
  if (to >= plays.back().to || to == stand) {
    // There is nowhere to go, or people will stand there anyway.
    if (rules_.lost != TimeLoss::hold) say(Command::Kind::hold_at_end, {}, now);
    return;
  }
  say(Command::Kind::jump, to, now);
}

void Chase::lose(Instant now) noexcept {
  tell(TimeAlarm::lost);
  if (rules_.lost == TimeLoss::go_on) {
    view_.follows = silent_ = waits_ = false;  // the engine keeps the last speed
    return;
  }
  let_go(now);
  say(rules_.lost == TimeLoss::hold ? Command::Kind::hold : Command::Kind::hold_at_end, {}, now);
}

void Chase::let_go(Instant now) noexcept {
  if (waits_) say(Command::Kind::run_on, {}, now);
  view_.follows = false;
  silent_ = fast_ = waits_ = false;
  step_from_.reset();
  leads_ = false;
  rehearsal_->lead(now, std::nullopt);
}

void Chase::lead(Instant now, double speed) noexcept {
  const int ppm = static_cast<int>(std::lround(speed * kMillion));
  if (leads_ && std::abs(ppm - led_ppm_) < kSameSpeed_ppm) return;
  leads_ = true;
  led_ppm_ = ppm;
  rehearsal_->lead(now, ppm);
}

}  // namespace footlight::controller
