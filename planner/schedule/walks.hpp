// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "planner/schedule/ways.hpp"

namespace footlight::planner {

/// Everybody walks from `from[i]` to `to[i]` between two instants; any other way of handing out the targets within a
/// kind is as good.
struct LegTask {
  const Ways* ways = nullptr;
  std::span<const CellIndex> from;  ///< distinct
  std::span<const CellIndex> to;    ///< distinct; to[i] is meant for from[i]
  double longest_m = 0;             ///< walks longer than this are too fast
  double clearance_m = 0.5;
  /// kind[i] is the kind of the person on from[i] and, since to[i] is meant for that person, of the target to[i]:
  /// people take targets of their own kind only. A kind of one's own is a name. Empty: everybody may take every target.
  std::span<const std::uint32_t> kind = {};
  /// Of the time between the two instants, how much anybody may be late, independently of all others; in [0, 1].
  double late_share = 0;
  /// Of the same time: somebody may leave later or be there earlier by multiples of it; 0: nobody does.
  double stagger_share = 0;
  /// Where the drawing may give way: one flag a cell, targets may be moved there to keep people apart.
  std::span<const char> free = {};
  std::span<const double> radius_m = {};  ///< of who is on from[i]: two keep the sum where it is more; empty: nobody's
  std::span<const char> fixed_target = {};  ///< one flag a target that must not be moved; empty: none
  const std::atomic<bool>* stop = nullptr;  ///< becomes true when the answer is no longer wanted; may be missing
};

struct Leg {
  std::vector<std::uint32_t> target_of;  ///< position in `to` for each of `from`, a bijection
  int exchanges = 0;
  /// Pairs (positions in `from`) below the clearance that could not be solved; empty when the leg is clear.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> conflicts;
  /// Pairs that come too near only when they are late; empty when the leg tolerates the lag.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> late_conflicts;
  /// When each of `from` walks, shares of the time between the instants; empty: everybody all the time.
  struct Timing {
    double start = 0;
    double end = 1;
  };
  std::vector<Timing> timing;
  /// A mark of one person's own between the two instants: she goes straight from mark to mark.
  struct Via {
    std::uint32_t person = 0;  ///< position in `from`
    double at = 0;             ///< share of the time, within her timing
    CellIndex cell;
  };
  std::vector<Via> vias;      ///< by person, then by time
  std::vector<CellIndex> to;  ///< the targets, where some have been moved; else empty
  bool walkable = true;       ///< every walk is short enough and clear of blocked cells
};

/// Hands out the targets so that nobody comes too close: exchange first; where a limit forbids the exchange the arcs
/// that conflict are made dearer, and the people among targets near their own are matched again until no conflict is
/// left. What conflicts only when people are late is then solved by small changes (`keep_apart_when_late`). Of a
/// pairing that is not walkable at the start the kinds with such walks get the exact pairing under the limits where
/// there is one.
/// @return a bijection also when it was stopped
[[nodiscard]] Leg settle(const LegTask& task);

}  // namespace footlight::planner
