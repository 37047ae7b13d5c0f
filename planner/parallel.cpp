// SPDX-License-Identifier: Apache-2.0
#include "planner/parallel.hpp"

#include <algorithm>

#include <tbb/parallel_for.h>

namespace footlight::planner {

bool for_each_index(std::size_t count, std::string_view stage, const Progress& progress,
                    const std::function<void(std::size_t)>& work) {
  // In portions, since progress is told from the calling thread only.
  const std::size_t portion = std::max<std::size_t>(8, count / 20);
  for (std::size_t first = 0; first < count; first += portion) {
    if (progress.stopped()) return false;
    progress.tell(stage, static_cast<double>(first) / static_cast<double>(count));
    tbb::parallel_for(first, std::min(count, first + portion), [&](std::size_t i) {
      if (!progress.stopped()) work(i);
    });
  }
  if (progress.stopped()) return false;
  progress.tell(stage, 1.0);
  return true;
}

}  // namespace footlight::planner
