// SPDX-License-Identifier: Apache-2.0
#include "app/live/cue_thread.hpp"

#include <algorithm>
#include <utility>

namespace footlight::app {

using controller::BusTarget;

namespace {

constexpr Duration kPublish = milliseconds(50);  // it says at least so often that it lives

}  // namespace

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

void CueThread::press_go() noexcept {
  presses_.fetch_add(1, std::memory_order_relaxed);
  waiting_.wake();
}

void CueThread::press_go_whenever_it_waits() noexcept {
  by_itself_.store(true, std::memory_order_relaxed);
  waiting_.wake();
}

void CueThread::run() noexcept {
  real_time_ = ask_for_real_time();
  while (!stopping_.load(std::memory_order_relaxed)) {
    const Instant now = clock_.now();
    show_.engine->step(now);
    press(now);
    publish(now);
    finished_.store(show_.engine->finished(), std::memory_order_relaxed);
    Instant next = std::min(now + kPublish, show_.engine->next_event());
    if (by_itself_.load(std::memory_order_relaxed)) next = std::min(next, go_.next());
    waiting_.until(next);
  }
}

void CueThread::press(Instant now) noexcept {
  const auto standby = show_.engine->standby();
  bool pressed = false;
  if (presses_.exchange(0, std::memory_order_relaxed) > 0) {  // several at once are one
    pressed = show_.engine->go(now) == controller::GoAnswer::started;
  } else if (by_itself_.load(std::memory_order_relaxed)) {
    if (!told_) go_ = GoWhenWaiting(now);
    told_ = true;
    pressed = go_.step(*show_.engine, now);
  }
  if (pressed && standby) go_at_[*standby] = now;
}

void CueThread::publish(Instant now) noexcept {
  const BusTarget target = show_.engine->target();
  target_.publish(target, now);
  const bool news = target.current != last_.current || target.next_at != last_.next_at;
  last_ = target;
  if (news) news_();
}

}  // namespace footlight::app
