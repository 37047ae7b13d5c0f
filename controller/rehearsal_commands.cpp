// SPDX-License-Identifier: Apache-2.0
// What may be said to a rehearsal, and what comes of it. Where the show stands by itself: rehearsal.cpp.
#include <algorithm>
#include <cmath>
#include <optional>

#include "controller/rehearsal.hpp"

namespace footlight::controller {
namespace {

constexpr Duration kResetLead = milliseconds(300);  // for preloads that have not come yet

std::optional<Outcome> refusal(Bars bars) {
  if ((bars & kEmergencyHold) != 0) return Outcome::emergency_hold;
  if ((bars & kHoldPressed) != 0) return Outcome::hold_pressed;
  if ((bars & kGates) != 0) return Outcome::gate_open;
  if ((bars & kNotReady) != 0) return Outcome::not_ready;
  return std::nullopt;
}

std::optional<Outcome> refusal(GoGuard::Verdict verdict) {
  switch (verdict) {
    case GoGuard::Verdict::too_soon:
      return Outcome::too_soon;
    case GoGuard::Verdict::held:
      return Outcome::key_held;
    case GoGuard::Verdict::switched_off:
      return Outcome::switched_off;
    case GoGuard::Verdict::taken:
      break;
  }
  return std::nullopt;
}

}  // namespace

Outcome Rehearsal::apply(const Command& command, Instant now) noexcept {
  step(now);
  const auto carry_out = [&] {
    switch (command.kind) {
      case Command::Kind::go:
        return go(command, now);
      case Command::Kind::step:
        // A GO for one count: people walk by it, so nothing of a GO is left out.
        if (const auto pressed = refusal(guard_.press(command.source, command.input, now))) return *pressed;
        return step_count(now);
      case Command::Kind::hold:
        return hold(now);
      case Command::Kind::hold_at_end:
        return hold_at_end(now);
      case Command::Kind::run_on:
        hold_.reset();
        return Outcome::done;
      case Command::Kind::back:
        return back(now);
      case Command::Kind::jump:
        return jump(command.position, now);
      case Command::Kind::loop:
        return set_loop(command, now);
      case Command::Kind::loop_off:
        loop_.reset();
        return Outcome::done;
      case Command::Kind::tempo:
        engine_.set_tempo(now, command.percent);
        return Outcome::done;
      case Command::Kind::reset_planned:
      case Command::Kind::reset_impossible:
        return answer_reset(command);
      case Command::Kind::placed:
        return placed();
      case Command::Kind::cancel:
        return cancel();
      case Command::Kind::mute:
        return mute(command.first, now);
      case Command::Kind::acknowledge:
        guard_.acknowledge();
        return Outcome::done;
      case Command::Kind::time_fix:
      case Command::Kind::follow:
      case Command::Kind::unfollow:
      case Command::Kind::join:
        return Outcome::no_source;  // they are the chase's, where there is one
    }
    return Outcome::done;
  };
  const Outcome outcome = carry_out();
  aim();
  step(now);
  return outcome;
}

Outcome Rehearsal::go(const Command& command, Instant now) noexcept {
  if (const auto pressed = refusal(guard_.press(command.source, command.input, now))) return *pressed;
  const bool moves = runs() || (resets() && !move_held_);
  if (const auto against = refusal(barred()); against && !moves) return *against;
  return go_on(now);
}

Outcome Rehearsal::go_on(Instant now) noexcept {
  if (resets()) {
    if (!move_held_) return Outcome::reset_runs;
    move_at_ = now + std::max(count_in(), notice_(target().current, row_switch(rows_lit_))) - *move_held_;
    move_held_.reset();
    return Outcome::goes_on;
  }
  if (runs()) return Outcome::cue_runs;
  if (stands_for_reset()) return start_reset(now);
  if (engine_.frozen()) {
    const BusTarget next = target();
    engine_.resume(now, now + std::max(count_in(), notice_(next.current, next.next)));
    return reset_.state == ResetState::none ? Outcome::goes_on : Outcome::walks_on;
  }
  return engine_.go(now, count_in()) == GoAnswer::started ? Outcome::cue_started : Outcome::nothing_left;
}

Outcome Rehearsal::start(Instant now, Instant at) noexcept {
  step(now);
  if (resets()) return Outcome::reset_runs;
  if (runs()) return Outcome::cue_runs;
  if (reset_.state != ResetState::none) return Outcome::being_planned;
  if (const auto against = refusal(barred())) return *against;
  Outcome outcome = Outcome::goes_on;
  if (engine_.frozen()) {
    const BusTarget next = engine_.target();
    engine_.resume(now, std::max(at, now + notice_(next.current, next.next)));
  } else {
    outcome = engine_.start(now, at) == GoAnswer::started ? Outcome::cue_started : Outcome::nothing_left;
  }
  aim();
  step(now);
  return outcome;
}

void Rehearsal::lead(Instant now, std::optional<int> ppm) noexcept {
  engine_.lead(now, ppm);
  aim();  // cues may follow by themselves that did not
}

void Rehearsal::move_start(Instant now, Instant at) noexcept {
  engine_.move_start(now, at);
  step(now);
}

void Rehearsal::make_up(Instant now, Duration ahead) noexcept {
  engine_.make_up(now, ahead);
  step(now);
}

Outcome Rehearsal::hold(Instant now) noexcept {
  if (resets()) {
    if (move_held_) return Outcome::nothing_runs;
    move_held_ = std::max(Duration{}, now - move_at_);
    return Outcome::done;
  }
  return engine_.freeze(now) ? Outcome::done : Outcome::nothing_runs;
}

Outcome Rehearsal::hold_at_end(Instant now) noexcept {
  if (!runs()) return Outcome::nothing_runs;
  const Instant here = engine_.position();
  const Instant stand = stands_.from(here, engine_.waits());
  if (stand == here) return hold(now);
  hold_ = stand;
  return Outcome::done;
}

Outcome Rehearsal::step_count(Instant now) noexcept {
  if (resets()) return Outcome::reset_runs;
  if (runs()) return Outcome::cue_runs;
  if (elsewhere_) return Outcome::reset_first;
  if (reset_.state != ResetState::none) return Outcome::being_planned;
  if (engine_.finished()) return Outcome::nothing_left;
  if (const auto against = refusal(barred())) return *against;
  const Instant here = engine_.position();
  double count = std::floor(tempo_.count_at(here)) + 1;
  while (tempo_.at(count) <= here) ++count;
  count_ = tempo_.at(count);
  return go_on(now);
}

// ---- other places

Outcome Rehearsal::back(Instant now) noexcept {
  const Instant here = reset_.state == ResetState::none ? engine_.position() : reset_.to;
  std::optional<Instant> begin;
  for (const CuePlay& play : engine_.plays()) {
    if (play.from < here) begin = play.from;
  }
  if (!begin) return Outcome::at_the_top;
  return jump(*begin, now);
}

Outcome Rehearsal::jump(Instant position, Instant now) noexcept {
  if (resets()) return Outcome::reset_runs;
  if (elsewhere_) return Outcome::reset_first;
  const auto& plays = engine_.plays();
  const Instant to = stands_.until(std::clamp(position, plays.front().from, plays.back().to));
  const Instant here = engine_.position();
  const Instant from = stands_.from(here, engine_.waits());
  if (runs() && from == here) engine_.freeze(now);
  planned_ = nullptr;
  reset_ = {};
  if (to == here && !runs() && engine_.waits()) return Outcome::done;
  reset_ = {ResetState::wanted, ++resets_asked_, from, to};
  return Outcome::done;
}

Outcome Rehearsal::set_loop(const Command& command, Instant now) noexcept {
  const auto& plays = engine_.plays();
  const auto on_the_show = [&](Instant at) { return std::clamp(at, plays.front().from, plays.back().to); };
  const Loop loop{stands_.until(on_the_show(command.position)), stands_.from(on_the_show(command.until), true)};
  if (loop.to <= loop.from) return Outcome::empty_range;
  if (resets()) return Outcome::reset_runs;
  if (elsewhere_) return Outcome::reset_first;
  loop_ = loop;
  const Instant here = engine_.position();
  return here >= loop.from && here < loop.to ? Outcome::done : jump(loop.from, now);
}

bool Rehearsal::stands_for_reset() const noexcept {
  // A walk that a hold has cut is walked to its end first.
  return reset_.state != ResetState::none && !runs() && engine_.position() == reset_.from;
}

Outcome Rehearsal::answer_reset(const Command& command) noexcept {
  if (command.reset != reset_.id || reset_.state != ResetState::wanted) return Outcome::no_reset;  // of a jump before
  const bool planned = command.kind == Command::Kind::reset_planned;
  reset_.state = planned ? ResetState::ready : ResetState::impossible;
  planned_ = planned ? command.move : nullptr;
  first_ = command.first;
  return Outcome::done;
}

Outcome Rehearsal::start_reset(Instant now) noexcept {
  if (reset_.state == ResetState::wanted) return Outcome::being_planned;
  if (reset_.state == ResetState::impossible) return Outcome::no_way;
  const Duration notice = notice_(target().current, target().next);
  move_ = planned_;
  rows_lit_ = first_row();
  move_held_.reset();
  move_at_ = now + std::max(notice, kResetLead);
  return Outcome::reset_started;
}

void Rehearsal::arrive() noexcept {
  engine_.place(reset_.to);
  elsewhere_ = false;
  move_ = planned_ = nullptr;
  move_held_.reset();
  reset_ = {};
}

Outcome Rehearsal::mute(std::size_t first, Instant now) noexcept {
  if (first > 0 && !engine_.schedule().is_muted_set(first)) return Outcome::done;  // of a plan that is over
  const std::size_t lit = target_of_all().current;
  muting_next_ = first;
  mutes_at_ = now + notice_(muted(lit, muting_), muted(lit, first));
  return Outcome::done;
}

Outcome Rehearsal::placed() noexcept {
  if (reset_.state == ResetState::none) return Outcome::no_reset;
  if (runs()) return Outcome::cue_runs;
  arrive();
  return Outcome::done;
}

Outcome Rehearsal::cancel() noexcept {
  if (resets()) return Outcome::reset_runs;
  if (elsewhere_) return Outcome::reset_first;
  if (reset_.state == ResetState::none) return Outcome::no_reset;
  reset_ = {};
  planned_ = nullptr;
  if (loop_ && engine_.position() == loop_->to) loop_.reset();  // or it would ask again
  return Outcome::done;
}

/// Tells the engine where to stop.
void Rehearsal::aim() noexcept {
  if (!runs()) return;
  const Instant here = engine_.position();
  std::optional<Instant> stop;
  const Instant end = engine_.plays().back().to;  // there it stops anyway
  const auto consider = [&](Instant at) {
    if (at > here && at < end && (!stop || at < *stop)) stop = at;
  };
  if (hold_) consider(*hold_);
  if (count_) consider(*count_);
  if (loop_) consider(loop_->to);
  if (reset_.state != ResetState::none) consider(reset_.from);
  // A cue that would follow by itself and may not.
  const auto& plays = engine_.plays();
  for (std::size_t c = *engine_.active(); c + 1 < plays.size() && engine_.gap_after(c); ++c) {
    if ((bars_ & kHolding & bars_of(plays[c + 1].cue)) == 0) continue;
    consider(plays[c].to);
    break;
  }
  engine_.stop_at(stop);
}

}  // namespace footlight::controller
