// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "planner/schedule/chain.hpp"

namespace footlight::planner {

struct MendTask {
  const ChainTask* chain = nullptr;
  /// The kind of each slot on the way to a stop, as StepTask::kind.
  std::function<std::vector<std::uint32_t>(std::size_t stop)> kind_toward;
  /// The radius of each slot's person, as StepTask::radius_m.
  std::function<std::vector<double>(std::size_t stop)> radius_toward;
  /// Marks on the way to an instant lie on multiples of this, s.
  std::function<double(Instant at)> beat_s;
  /// The floor of the walk to a stop.
  std::function<const Ways*(std::size_t stop)> ways_toward;
};

/// Where the walks to an exact formation conflict (also when people are late) or cannot be walked, puts other walks in
/// their place, with marks on the way. Those who conflict go around the others (`detour`), who walk as before. Where
/// that is not enough everybody walks from mark to mark: around blocked cells, where everybody may take every target,
/// people are shifted from cell to cell, which is found whenever there is time for it; else they pass each other
/// (`pass`). What stays as it is stands in `chain.unpassed` where the walks are not simply too long.
/// @return false when stopped
[[nodiscard]] bool mend(const MendTask& task, Chain& chain, const Progress& progress);

}  // namespace footlight::planner
