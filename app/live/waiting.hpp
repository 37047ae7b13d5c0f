// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/clock.hpp"
#include "core/file_descriptor.hpp"
#include "core/time.hpp"

namespace footlight::app {

/// What a thread of the show sleeps on: until an instant, until its wire has something, or until another thread wakes
/// it. One thread waits, any may wake.
class Waiting {
 public:
  enum class Why {
    time,   ///< the instant has come
    input,  ///< the wire has something
    woken,
    trouble,  ///< the wire says that something is wrong with it, and nothing else
  };

  explicit Waiting(const Clock& clock);
  /// Does not block.
  void wake() const noexcept;
  /// @param until as soon as it has come, when it lies in the past  @param file to watch for input, -1: none
  Why until(Instant until, int file = -1) const noexcept;

 private:
  const Clock& clock_;
  FileDescriptor event_;
};

/// Of SCHED_FIFO: above what a desktop runs so, below the kernel's own threads.
inline constexpr int kShowPriority = 20;

/// Asks the kernel for what a thread of the show wants: short timers, and to run before others where that is allowed
/// (SCHED_FIFO: the privilege CAP_SYS_NICE or a limit for rtprio). @return true when it was
bool ask_for_real_time() noexcept;
/// What a thread asks for that must never stand in the way of the show's, whatever the program was started with.
void yield_to_the_show() noexcept;

/// Processor time that the calling thread has used.
[[nodiscard]] Duration thread_cpu() noexcept;

}  // namespace footlight::app
