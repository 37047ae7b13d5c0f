// SPDX-License-Identifier: Apache-2.0
#include "controller/rehearsal.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "core/check.hpp"

namespace footlight::controller {

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
