// SPDX-License-Identifier: Apache-2.0
#include "planner/parallel.hpp"

#include <atomic>
#include <thread>

#include <tbb/parallel_for.h>

namespace footlight::planner {

bool for_each_index(std::size_t count, std::string_view stage, const Progress& progress,
                    const std::function<void(std::size_t)>& work) {
  if (progress.stopped()) return false;
  progress.tell(stage, 0.0);
  const auto caller = std::this_thread::get_id();
  const std::size_t portion = count / 50 + 1;
  std::atomic<std::size_t> done = 0;
  std::size_t told = 0;
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    if (progress.stopped()) return;
    work(i);
    const std::size_t now = done.fetch_add(1, std::memory_order_relaxed) + 1;
    // The caller works, too, and tells what all have done.
    if (std::this_thread::get_id() != caller || now < told + portion || now == count) return;
    told = now;
    progress.tell(stage, static_cast<double>(now) / static_cast<double>(count));
  });
  if (progress.stopped()) return false;
  progress.tell(stage, 1.0);
  return true;
}

}  // namespace footlight::planner
