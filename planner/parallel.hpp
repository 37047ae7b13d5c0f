// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

#include "planner/progress.hpp"

namespace footlight::planner {

/// Calls work(i) for every i in [0, count) on all cores and tells the calling thread's progress. The calls must not
/// depend on each other, so that the result is the same for any number of threads.
/// @return false when the user stopped it before all of it was done
bool for_each_index(std::size_t count, std::string_view stage, const Progress& progress,
                    const std::function<void(std::size_t)>& work);

}  // namespace footlight::planner
