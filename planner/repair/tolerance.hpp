// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "planner/repair/exchange.hpp"
#include "planner/repair/lateness.hpp"

namespace footlight::planner {

/// Straight walks between two instants, and how late anybody may be.
struct ToleranceTask {
  const Grid* grid = nullptr;
  std::span<const CellIndex> from;      ///< distinct
  std::span<const std::uint32_t> kind;  ///< who may exchange targets, as in `LegTask`; empty: everybody
  double clearance_m = 0.5;             ///< that two people keep
  double late_share = 0;                ///< of the time that anybody may be late; in [0, 1]
  const MayWalk* may_walk = nullptr;    ///< speed and blocked cells
  double longest_m = 0;                 ///< what can be walked in the whole time
  double stagger_share = 0;         ///< of the time: waits before and after walks are multiples of it; 0: nobody waits
  std::span<const char> free = {};  ///< one flag a cell: a target may be moved here; empty: no target moves
  std::span<const double> radius_m = {};    ///< of each of `from`: two keep the sum where it is more; empty: nobody's
  std::span<const char> fixed_target = {};  ///< one flag a target: stays where it is; empty: none has to
  const std::atomic<bool>* stop = nullptr;  ///< becomes true when the answer is no longer wanted; may be missing
};

struct Tolerance {
  std::vector<TimedWalk> walks;  ///< of each of `from`
  int exchanges = 0;
  int waits = 0;  ///< people who leave later or arrive earlier than the others
  int moved = 0;  ///< targets that give way
  /// Pairs (positions in `from`, first < second, ascending) that come too near when they are as late as they may be.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> left;
};

/// Changes as few walks as it can so that nobody comes too near though everybody may be late. For each pair that would:
/// targets are exchanged with people whose targets are near; one of the two leaves later or is there earlier, as far as
/// the limit of speed allows; or, where the drawing may give way, a target is moved to a free cell near it. A change is
/// made only when it lowers the number of pairs too near (pairs too near even when punctual count before all others),
/// so it ends.
///
/// Why little is needed: two people who walk around each other by a quarter turn may turn either way for the same sum
/// of squares, and in one of the two ways they are side by side when they are nearest, where lateness does not bring
/// them together. Who goes ahead of another gains his whole wait.
/// @param to in and out: distinct cells  @param target_of in and out: a bijection onto positions in `to`
/// O(near pairs + pairs too near x people in a neighbourhood). Deterministic.
Tolerance keep_apart_when_late(const ToleranceTask& task, std::vector<CellIndex>& to,
                               std::vector<std::uint32_t>& target_of);

}  // namespace footlight::planner
