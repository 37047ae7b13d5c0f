// SPDX-License-Identifier: Apache-2.0
#pragma once

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
};

struct Leg {
  std::vector<std::uint32_t> target_of;  ///< position in `to` for each of `from`, a bijection
  int exchanges = 0;
  /// Pairs (positions in `from`) below the clearance that could not be solved; empty when the leg is clear.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> conflicts;
  bool walkable = true;  ///< every walk is short enough and clear of blocked cells
};

/// Hands out the targets so that nobody comes too close: exchange first; where a limit forbids the exchange the arcs
/// that conflict are made dearer, and the people among targets near their own are matched again until no conflict is
/// left. Of a pairing that is not walkable at the start the kinds with such walks get the exact pairing under the
/// limits where there is one.
[[nodiscard]] Leg settle(const LegTask& task);

}  // namespace footlight::planner
