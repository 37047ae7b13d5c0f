// SPDX-License-Identifier: Apache-2.0
#include "app/live/waiting.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <sys/eventfd.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include "core/check.hpp"

namespace footlight::app {
namespace {

constexpr int kNice = 5;
constexpr Duration kLongestSleep = std::chrono::seconds(10);

}  // namespace

Waiting::Waiting(const Clock& clock) : clock_(clock), event_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  FL_CHECK(event_.get() >= 0);
}

void Waiting::wake() const noexcept {
  const std::uint64_t one = 1;
  (void)!::write(event_.get(), &one, sizeof one);  // full: it is awake
}

Waiting::Why Waiting::until(Instant until, int file) const noexcept {
  const Duration left = std::clamp(until - clock_.now(), Duration{}, kLongestSleep);
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(left);
  const timespec timeout{static_cast<time_t>(whole.count()), static_cast<long>((left - whole).count())};
  std::array<pollfd, 2> files{pollfd{event_.get(), POLLIN, 0}, pollfd{file, POLLIN, 0}};
  if (::ppoll(files.data(), file < 0 ? 1 : 2, &timeout, nullptr) <= 0) return Why::time;
  if (files[0].revents != 0) {
    std::uint64_t count = 0;
    (void)!::read(event_.get(), &count, sizeof count);
    return Why::woken;
  }
  return (files[1].revents & POLLIN) != 0 ? Why::input : Why::trouble;
}

bool ask_for_real_time() noexcept {
  (void)::prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
  sched_param parameter{};
  parameter.sched_priority = kShowPriority;
  return ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &parameter) == 0;
}

void yield_to_the_show() noexcept {
  sched_param parameter{};
  (void)::pthread_setschedparam(::pthread_self(), SCHED_OTHER, &parameter);
  (void)::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), kNice);  // of this thread alone, on Linux
}

Duration thread_cpu() noexcept {
  rusage used{};
  (void)::getrusage(RUSAGE_THREAD, &used);
  const auto of = [](const timeval& time) { return std::chrono::seconds(time.tv_sec) + microseconds(time.tv_usec); };
  return of(used.ru_utime) + of(used.ru_stime);
}

}  // namespace footlight::app
