// SPDX-License-Identifier: Apache-2.0
#include "app/live/bus_thread.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <variant>

namespace footlight::app {
namespace {

constexpr Duration kLook = milliseconds(200);          // at a port that has no handle, or has been unplugged
constexpr Duration kTroubled = milliseconds(20);       // a wire that says again and again that it is gone
constexpr Duration kCount = milliseconds(100);         // counters are told so often, and the port is asked how it is
constexpr Duration kHandedOverLate = microseconds(1);  // what is due a moment from now is as good as due

std::uint32_t flag_of(controller::BusLoop::Keeps keeps, bool can_tell) {
  using Keeps = controller::BusLoop::Keeps;
  if (!can_tell) return NodeBoard::kNoChecks;
  switch (keeps) {
    case Keeps::unknown:
      return 0;
    case Keeps::same:
      return NodeBoard::kSameChecks;
    case Keeps::other_plan:
      return NodeBoard::kOtherPlan;
    case Keeps::other_patch:
      return NodeBoard::kOtherPatch;
    case Keeps::no_patch:
      return NodeBoard::kNoPatch;
    case Keeps::untold:
      return NodeBoard::kNoChecks;
  }
  return 0;
}

}  // namespace

BusThread::BusThread(controller::BusLoop& loop, drivers::PortReference port, const SharedTarget& target,
                     const Clock& clock, std::size_t switches)
    : loop_(loop), port_(port), target_(target), clock_(clock), waiting_(clock), times_(switches) {}

BusThread::~BusThread() { stop(); }

void BusThread::start() {
  thread_ = std::thread([this] { run(); });
}

void BusThread::stop() {
  if (!thread_.joinable()) return;
  stopping_.store(true, std::memory_order_relaxed);
  waiting_.wake();
  thread_.join();
}

void BusThread::run() noexcept {
  real_time_ = ask_for_real_time();
  bool troubled = false;
  while (!stopping_.load(std::memory_order_relaxed)) {
    const Instant now = clock_.now();
    const Instant wish = step(now);
    if (wish <= now + kHandedOverLate) continue;
    const Instant until = std::min(wish, now + (troubled ? kTroubled : kLook));
    const int handle = std::visit([](const auto* port) { return port->poll_handle(); }, port_);
    const Waiting::Why why = waiting_.until(until, troubled ? -1 : handle);
    if (why == Waiting::Why::time && until == wish) wake_lateness_.add(clock_.now() - until);
    troubled = why == Waiting::Why::trouble;
  }
  cpu_ = thread_cpu();
}

Instant BusThread::step(Instant now) noexcept {
  const SharedTarget::Told told = target_.read();
  const bool deaf = now - told.at > kDeaf;
  deaf_ += deaf && !is_deaf_ ? 1 : 0;
  is_deaf_ = deaf;
  if (deaf) return now + kLook;
  if (told.plan != plan_.load(std::memory_order_relaxed)) return go_over(now, told);
  const Instant wish = loop_.step(now, told.target);
  note(now);
  return wish;
}

/// The loop takes the other schedule when its driver is ready; until then nothing of the new plan is sent.
Instant BusThread::go_over(Instant now, const SharedTarget::Told& told) noexcept {
  Next& next = *next_.load(std::memory_order_acquire);
  if (before_ == nullptr) {
    before_ = &loop_.schedule();
    loop_.take(*next.part);
    for (std::size_t i = 0; board_ != nullptr && i < loop_.nodes(); ++i) {
      board_->put(loop_.standing(i).node.at(), {NodeBoard::kNothingYet, 0});
    }
    told_.store(told.plan, std::memory_order_release);
  }
  const Instant wish = loop_.step(now, told.target);
  if (&loop_.schedule() == before_) return wish;
  before_ = nullptr;
  times_.swap(next.times);
  lit_ = std::min(loop_.lit(), times_.size() - 1);
  latches_ = loop_.counters().latches;
  note(now);
  plan_.store(told.plan, std::memory_order_release);
  return wish;
}

void BusThread::note(Instant now) noexcept {
  const std::size_t lit = loop_.lit();
  if (lit != lit_ && lit < times_.size()) {
    times_[lit_].unconfirmed = static_cast<std::uint32_t>(unconfirmed_.load(std::memory_order_relaxed));
    // Where no lamp of the bus changes there is no latch.
    if (loop_.counters().latches != latches_) times_[lit].latched = now;
    latches_ = loop_.counters().latches;
    lit_ = lit;
  }
  tell_word(now);
  // What was confirmed over a wire that is down now is not known any more.
  const bool down = told_word_.trouble[0] != '\0';
  const std::size_t unconfirmed = down ? loop_.nodes() : loop_.unconfirmed();
  if (unconfirmed == 0 && times_[lit_].confirmed == kNever) {
    times_[lit_].confirmed = now;
    if (times_[lit_].latched != kNever) told_word_.confirmed_after = now - times_[lit_].latched;
  }
  unconfirmed_.store(unconfirmed, std::memory_order_relaxed);
  settled_.store(loop_.settled() && !down, std::memory_order_relaxed);
  tell_board();
}

void BusThread::tell_word(Instant now) noexcept {
  if (word_at_ != Instant::min() && now - word_at_ < kCount) return;
  word_at_ = now;
  const std::string trouble = drivers::trouble_of(port_);
  told_word_.trouble.fill('\0');
  trouble.copy(told_word_.trouble.data(), told_word_.trouble.size() - 1);
  told_word_.counters = loop_.counters();
  word_.write(told_word_);
}

void BusThread::tell_board() noexcept {
  if (board_ == nullptr) return;
  const bool down = told_word_.trouble[0] != '\0';
  std::size_t quarantined = 0;
  for (std::size_t i = 0; i < loop_.nodes(); ++i) {
    const auto node = loop_.standing(i);
    quarantined += node.quarantined ? 1 : 0;
    NodeBoard::View view = board_->at(node.node.at());
    if (node.right) view.shown = static_cast<std::uint32_t>(loop_.lit());
    view.flags = (node.right && !down ? NodeBoard::kRight : 0U) | (node.silent || down ? NodeBoard::kSilent : 0U) |
                 (node.quarantined ? NodeBoard::kQuarantined : 0U) | (loop_.verifies() ? 0U : NodeBoard::kUnverified) |
                 flag_of(node.keeps, loop_.keeps_checks());
    board_->put(node.node.at(), view);
    board_->put_boots(node.node.at(), node.boots);
  }
  quarantined_.store(quarantined, std::memory_order_relaxed);
}

}  // namespace footlight::app
