// SPDX-License-Identifier: Apache-2.0
#include "app/live/cue_thread.hpp"

#include <algorithm>
#include <utility>

namespace footlight::app {
namespace {

using controller::BusTarget;
using controller::Command;

constexpr Duration kPublish = milliseconds(50);  // the cue thread says at least so often that it lives
constexpr int kCommandsAtOnce = 8;               // then what is due comes first again

int as_number(const std::optional<std::size_t>& cue) { return cue ? static_cast<int>(*cue) : -1; }

}  // namespace

CueThread::CueThread(controller::Rehearsal& rehearsal, TimeRules rules, SharedTarget& target, const Clock& clock)
    : rehearsal_(&rehearsal),
      chase_(rehearsal, std::move(rules)),
      target_(target),
      clock_(clock),
      waiting_(clock),
      go_at_(rehearsal.engine().plays().size(), kNever) {}

void CueThread::take_up(const TakenUp& up, Instant now) noexcept {
  rehearsal_->take_up(up.where, now);
  chase_.take_up(up.time);
}

void CueThread::start(std::function<void()> news) {
  news_ = std::move(news);
  publish(clock_.now());
  thread_ = std::thread([this] { run(); });
}

void CueThread::stop() {
  if (!thread_.joinable()) return;
  stopping_.store(true, std::memory_order_relaxed);
  waiting_.wake();
  thread_.join();
}

bool CueThread::tell(const Command& command) noexcept {
  const bool taken = commands_.push(command);
  waiting_.wake();
  return taken;
}

void CueThread::hand_over(Next& next) noexcept {
  handed_.store(Handed::waiting, std::memory_order_relaxed);
  next_.store(&next, std::memory_order_release);
  waiting_.wake();
}

CueThread::Handed CueThread::handed() noexcept {
  const Handed now = handed_.load(std::memory_order_acquire);
  if (now == Handed::done || now == Handed::refused) handed_.store(Handed::nothing, std::memory_order_relaxed);
  return now;
}

void CueThread::press_go_whenever_it_waits() noexcept {
  by_itself_.store(true, std::memory_order_relaxed);
  waiting_.wake();
}

void CueThread::set_bars(controller::Bars bars) noexcept {
  if (bars_.exchange(bars, std::memory_order_acq_rel) != bars) waiting_.wake();
}

void CueThread::run() noexcept {
  real_time_ = ask_for_real_time();
  while (!stopping_.load(std::memory_order_relaxed)) {
    const Instant now = clock_.now();
    rehearsal_->step(now);
    const controller::Bars bars = bars_.load(std::memory_order_acquire);
    if (bars != std::exchange(barred_, bars)) rehearsal_->set_bars(bars, now);
    take_commands(now);
    go_over(now);
    chase_.step(now);
    if (by_itself_.load(std::memory_order_relaxed)) press_by_itself(now);
    publish(now);
    Instant next = std::min({now + kPublish, rehearsal_->next_event(), chase_.next_event(now)});
    if (by_itself_.load(std::memory_order_relaxed)) next = std::min(next, go_.next());
    waiting_.until(next);
  }
}

void CueThread::take_commands(Instant now) noexcept {
  for (int i = 0; i < kCommandsAtOnce; ++i) {
    const auto command = commands_.pop();
    if (!command) return;
    carry_out(*command, now);
  }
  waiting_.wake();  // there may be more
}

void CueThread::carry_out(const Command& command, Instant now) noexcept {
  const auto standby = rehearsal_->engine().standby();
  if (command.kind == Command::Kind::time_fix) return chase_.hear(command);
  const controller::Outcome outcome = chase_.take(command, now);
  if (outcome == controller::Outcome::cue_started && standby) go_at_[*standby] = now;
  (void)answers_.push({command, outcome, now});  // full: nobody listens
}

void CueThread::go_over(Instant now) noexcept {
  Next* next = next_.exchange(nullptr, std::memory_order_acquire);
  if (next == nullptr) return;
  const bool may = rehearsal_->may_change_plan() && rehearsal_->engine().position() == next->from;
  if (may) {
    next->rehearsal->carry_on(*rehearsal_, now);
    rehearsal_ = next->rehearsal;
    rehearsal_->step(now);
    chase_.carry_on(*rehearsal_, now);
    go_at_.swap(next->go_at);
    plan_ = next->plan;
    publish(now);  // what the calling thread reads after `handed` is of this plan
    news_();
  }
  handed_.store(may ? Handed::done : Handed::refused, std::memory_order_release);
}

void CueThread::press_by_itself(Instant now) noexcept {
  if (!told_) go_ = GoWhenWaiting(now);
  told_ = true;
  if (go_.due(rehearsal_->engine(), now)) carry_out(Command{}, now);
}

void CueThread::publish(Instant now) noexcept {
  const BusTarget target = rehearsal_->target();
  target_.publish(target, now, plan_);
  const controller::CueEngine& engine = rehearsal_->engine();
  ShowState state;
  state.phase = rehearsal_->phase();
  state.reset = rehearsal_->reset();
  state.loops = rehearsal_->loop().has_value();
  state.loop = rehearsal_->loop().value_or(controller::Rehearsal::Loop{});
  state.holds_at_end = rehearsal_->holds_at_end();
  state.percent = engine.percent();
  state.wanted_percent = std::min(engine.wanted_percent(), engine.limit_percent());
  state.time = chase_.view();
  state.limit_percent = engine.limit_percent();
  state.active = as_number(engine.active());
  state.standby = as_number(engine.standby());
  state.position = engine.position();
  state.goes_at = rehearsal_->goes_at();
  if (engine.active()) state.ends_at = engine.clock_at(engine.plays()[*engine.active()].to);
  state.at = now;
  state.barred = rehearsal_->barred();
  state.inputs_off = rehearsal_->inputs_off();
  state.where = rehearsal_->whereabouts();
  state.target = target;
  state.plan = plan_;
  state_.write(state);
  const bool news = target.current != last_.current || target.next != last_.next || target.next_at != last_.next_at;
  last_ = target;
  if (news) news_();
}

}  // namespace footlight::app
