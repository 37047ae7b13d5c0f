// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>

#include "planner/parallel.hpp"

namespace footlight::planner {

/// Calls work(i) for every person, in parallel over fixed chunks. The calls must not depend on each other.
template <class Work>
void in_chunks(std::size_t people, const Work& work) {
  constexpr std::size_t kChunk = 128;
  for_each_index((people + kChunk - 1) / kChunk, "motion", {}, [&](std::size_t chunk) {
    const std::size_t end = std::min(people, (chunk + 1) * kChunk);
    for (std::size_t i = chunk * kChunk; i < end; ++i) work(i);
  });
}

}  // namespace footlight::planner
