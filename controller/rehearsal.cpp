// SPDX-License-Identifier: Apache-2.0
#include "controller/rehearsal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/check.hpp"

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

}  // namespace

std::string_view to_text(Outcome outcome) {
  constexpr std::array<std::string_view, 24> kTexts{
      "done",
      "the cue starts",
      "the show goes on",
      "people walk on to the end of the set; then press GO for the reset move",
      "the reset move starts",
      "too soon after the last GO",
      "the key has not been up since the last GO",
      "this input was pressed for more than 5 s and is switched off until somebody acknowledges it",
      "the cue runs",
      "the last cue has been played",
      "the reset move is still being planned",
      "no reset move was found: send people to their places by word of mouth, then say that they are placed",
      "a reset move is under way",
      "nothing runs",
      "this is the top of the show",
      "no reset move is asked for",
      "people have to go to their places of the new plan first: GO lights the way",
      "the loop has no length: nobody stands at its beginning before its end",
      "a gate that it needs is open, or nobody knows",
      "a hold button is pressed",
      "emergency hold: when people are safe and the button is out, acknowledge it (ok)",
      "the show is not ready",
      "lost: too many commands at once",
      "no source of time is followed: it has to be locked, and far enough before the end of the show",
  };
  return kTexts.at(static_cast<std::size_t>(outcome));
}

Rehearsal::Rehearsal(CueEngine& engine, TempoMap tempo, Stands stands, Settings settings, Notice notice)
    : engine_(engine),
      tempo_(std::move(tempo)),
      stands_(std::move(stands)),
      settings_(settings),
      notice_(std::move(notice)),
      guard_(settings.least_between_gos) {
  FL_CHECK(notice_ != nullptr && settings.count_in_counts >= 0);
}

void Rehearsal::begin_at(Instant position) noexcept {
  const auto& plays = engine_.plays();
  engine_.place(std::clamp(position, plays.front().from, plays.back().to));
}

void Rehearsal::begin_elsewhere(Instant position, std::size_t first, const ResetMove& move) noexcept {
  begin_at(position);
  reset_ = {ResetState::ready, ++resets_asked_, engine_.position(), engine_.position()};
  planned_ = &move;
  first_ = first;
  elsewhere_ = true;
}

void Rehearsal::carry_on(const Rehearsal& before, Instant now) noexcept {
  now_ = now;
  guard_ = before.guard_;
  bars_ = before.bars_;
  resets_asked_ += before.resets_asked_;  // an answer that is still on its way is none of ours
  reset_.id += before.resets_asked_;
  engine_.set_tempo(now, before.engine_.wanted_percent());
}

bool Rehearsal::may_change_plan() const noexcept {
  const Instant here = engine_.position();
  return !runs() && !resets() && reset_.state == ResetState::none && engine_.waits() && stands_.until(here) == here;
}

// ---- time

void Rehearsal::take_up(const Whereabouts& where, Instant now) noexcept {
  engine_.set_tempo(std::min(now, where.runs_since.value_or(now)), where.percent);
  if (where.cue && *where.cue < engine_.plays().size()) {
    engine_.take_up(*where.cue, where.position, where.waits, where.runs_since);
    hold_ = where.hold_at;
    count_ = where.step_to;
  } else {
    begin_at(where.position);
  }
  loop_ = where.loop;
  aim();
  step(now);
}

Rehearsal::Whereabouts Rehearsal::whereabouts() const noexcept {
  Whereabouts where;
  where.percent = engine_.wanted_percent();
  where.loop = loop_;
  where.hold_at = hold_;
  where.step_to = count_;
  if (resets()) {
    where.position = reset_.to;
    return where;
  }
  where.position = engine_.position();
  where.cue = engine_.active();
  where.waits = engine_.waits();
  if (!runs()) return where;
  where.runs_since = std::max(now_, engine_.goes_at());
  return where;
}

void Rehearsal::step(Instant now) noexcept {
  now_ = now;
  engine_.step(now);
  obey_bars(now);
  if (resets() && !move_held_) {
    while (rows_lit_ < rows() && row_at(rows_lit_) <= now) ++rows_lit_;
    if (row_at(rows()) <= now) arrive();
  }
  if (mutes_at_ <= now) {
    muting_ = muting_next_;
    mutes_at_ = kNever;
  }
  if (runs()) return;
  hold_.reset();
  count_.reset();
  // The end of a loop asks for the way back to its beginning.
  if (loop_ && reset_.state == ResetState::none && engine_.position() == loop_->to) (void)jump(loop_->from, now);
}

Instant Rehearsal::next_event() const noexcept {
  const Instant moves = resets() ? (move_held_ ? kNever : row_at(rows_lit_)) : engine_.next_event();
  return std::min(moves, mutes_at_);
}

BusTarget Rehearsal::target() const noexcept {
  BusTarget target = target_of_all();
  const std::size_t lit = target.current;
  target.current = muted(lit, muting_);
  if (mutes_at_ < target.next_at && muted(lit, muting_next_) != target.current) {
    // All buses together, before the next switch of the show.
    target.next = muted(lit, muting_next_);
    target.next_at = mutes_at_;
  } else {
    target.next = muted(target.next, muting_);
  }
  return target;
}

/// A reset move concerns everybody: its lamps are never muted.
std::size_t Rehearsal::muted(std::size_t k, std::size_t first) const noexcept {
  return first > 0 && k < engine_.schedule().switches().size() ? first + k : k;
}

/// With nobody muted.
BusTarget Rehearsal::target_of_all() const noexcept {
  BusTarget target = engine_.target();
  const Instant at = goes_at();
  if (at != kNever && !resets()) {
    // Wearables count the count-in down, too.
    const double left_s = to_seconds(at - now_) * target.rate;
    target.show_time -= seconds(std::min(left_s, 60.0));
  }
  if (elsewhere_) target.current = first_;
  if (resets()) {
    if (rows_lit_ > 0) target.current = row_switch(rows_lit_ - 1);
    target.next = row_switch(rows_lit_);
    target.next_at = move_held_ ? kNever : row_at(rows_lit_);
    target.show_time = move_held_.value_or(std::max(Duration{}, now_ - move_at_));
    target.rate = 1;
  } else if (planned_ != nullptr && stands_for_reset()) {
    target.next = rows() > first_row() ? first_ + first_row() : lit_at(engine_.schedule(), reset_.to, true);
    target.next_at = kNever;
  }
  return target;
}

Rehearsal::Phase Rehearsal::phase() const noexcept {
  if (resets()) return move_held_ ? Phase::reset_held : Phase::resets;
  if (runs()) return goes_at() == kNever ? Phase::runs : Phase::counts_in;
  return engine_.finished() ? Phase::finished : Phase::stands;
}

Instant Rehearsal::goes_at() const noexcept {
  if (resets()) return now_ < move_at_ && !move_held_ ? move_at_ : kNever;
  const Instant at = engine_.goes_at();
  return at == kNever || at <= now_ ? kNever : at;
}

Duration Rehearsal::count_in() const noexcept {
  const double count = tempo_.count_at(engine_.position());
  const double span_s = to_seconds(tempo_.span(count, settings_.count_in_counts));
  if (settings_.count_in_counts == 0) return {};
  return settings_.before_count_in + seconds(span_s * 100 / engine_.percent());
}

// ---- commands

Outcome Rehearsal::apply(const Command& command, Instant now) noexcept {
  step(now);
  const auto carry_out = [&] {
    switch (command.kind) {
      case Command::Kind::go:
        return go(command, now);
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
      case Command::Kind::step:
        return step_count(now);
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
  switch (guard_.press(command.source, command.input, now)) {
    case GoGuard::Verdict::too_soon:
      return Outcome::too_soon;
    case GoGuard::Verdict::held:
      return Outcome::key_held;
    case GoGuard::Verdict::switched_off:
      return Outcome::switched_off;
    case GoGuard::Verdict::taken:
      break;
  }
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
  if (!engine_.frozen()) {
    (void)engine_.go(now);
  } else {
    const BusTarget next = target();
    engine_.resume(now, now + notice_(next.current, next.next));
  }
  return Outcome::done;
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

// ---- what stands against walking

void Rehearsal::set_bars(Bars bars, Instant now) noexcept {
  step(now);
  bars_ = bars;
  obey_bars(now);
  aim();
  step(now);
}

void Rehearsal::obey_bars(Instant now) noexcept {
  const bool moves = runs() || (resets() && !move_held_);
  if (moves && (barred() & kHolding) != 0) (void)hold(now);
}

Bars Rehearsal::bars_at(Instant position) const noexcept {
  for (const CuePlay& play : engine_.plays()) {
    if (position <= play.to) return bars_of(play.cue);
  }
  return bars_of(engine_.plays().back().cue);
}

Bars Rehearsal::barred() const noexcept {
  Bars needed = ~kGates;
  if (resets() || stands_for_reset()) {
    // Nobody knows where on the stage the way back leads: what either place needs.
    needed = bars_at(reset_.from) | bars_at(reset_.to);
  } else if (engine_.active()) {
    needed = bars_of(engine_.plays()[*engine_.active()].cue);
  } else if (const auto standby = engine_.standby()) {
    needed = bars_of(engine_.plays()[*standby].cue);
  }
  return bars_ & needed;
}

// ---- the rows of a reset move

std::size_t Rehearsal::rows() const noexcept {
  return planned_ == nullptr || planned_->switches.empty() ? 0 : planned_->switches.size() - 1;
}

Instant Rehearsal::row_at(std::size_t row) const noexcept {
  const auto& switches = planned_->switches;
  return row < switches.size() ? move_at_ + switches[row].time.time_since_epoch() : move_at_;
}

std::size_t Rehearsal::row_switch(std::size_t row) const noexcept {
  return row < rows() ? first_ + row : lit_at(engine_.schedule(), reset_.to, true);
}

}  // namespace footlight::controller
