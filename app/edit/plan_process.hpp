// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace footlight::app {

/// What is to be planned beside a show that runs.
struct PlanOrder {
  std::string show;
  std::vector<std::string> absent{};  ///< ids
  std::vector<std::string> covers{};  ///< "4=zoe"
  std::string output;                 ///< plan file; its stages are kept beside it
};

/// The calling thread gets a processor when nobody else wants it, and preempts nobody (SCHED_BATCH, nice 19). Only
/// system calls: may stand between fork and exec.
void take_the_lowest_priority() noexcept;

/// `footlight plan` in a process of its own, of the lowest priority, of which the kernel thinks first when memory is
/// short, and which has 6 GiB of addresses at most: whatever becomes of it, the show goes on. Waits for its end.
/// Errors: as that command's, with its words; interrupted when `stop` has become true.
[[nodiscard]] Status<> plan_in_a_process(const PlanOrder& order, const std::atomic<bool>& stop);

}  // namespace footlight::app
