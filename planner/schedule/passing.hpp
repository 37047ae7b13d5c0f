// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "planner/progress.hpp"
#include "planner/schedule/ways.hpp"

namespace footlight::planner {

/// People who may not take each other's targets and whose straight walks cannot all be made: they pass each other with
/// marks on the way.
struct PassTask {
  const Ways* ways = nullptr;
  std::span<const CellIndex> from;  ///< distinct, can be stood on
  std::span<const CellIndex> to;    ///< distinct, can be stood on; to[i] is meant for from[i]
  /// As LegTask::kind: targets are exchanged within a kind only. Empty: everybody with everybody.
  std::span<const std::uint32_t> kind = {};
  double clearance_m = 0.5;
  double speed_mps = 1.4;                 ///< nobody walks faster
  double time_s = 0;                      ///< there is
  double lag_s = 0;                       ///< how late anybody may be
  std::span<const double> radius_m = {};  ///< as LegTask::radius_m
};

struct Passing {
  std::vector<std::vector<CellIndex>> at;  ///< of each step and person; the first are `from`
  std::vector<double> longest_m;           ///< walk of each step; one less
  std::vector<std::uint32_t> target_of;    ///< position in `to` of each person, a bijection
  double needed_s = 0;                     ///< that the steps take at the speed limit
  std::uint32_t last = 0;                  ///< who arrives last: position in `from`
  bool tolerates_lag = false;              ///< in steps of at least `needed_s` / steps
};

/// Straight walks from mark to mark, all of a step at once, to places that are looked for person by person: whoever has
/// been on her way longest chooses first, the free cell nearest to her target that can be walked to in one step; who
/// stands there has to leave first, by the same rule, and inherits the choice (priority inheritance with backtracking).
/// A walk is taken only when it is clear, in closed form, of every walk that has been chosen and of everybody who could
/// still stay: so that whoever has not chosen yet can stay, and every step is clear as a whole. Long steps are tried
/// first (3 pitches), then shorter ones, down to neighbouring cells; first so that everybody may be late, then
/// punctual.
///
/// Source: Okumura, Machida, Defago, Tamura 2022, "Priority inheritance with backtracking for iterative multi-agent
/// path finding"; there cells and edges are what people take, here walks, with their clearance.
/// @return what is in time, tried in this order, else what takes the least time; nothing when none of these arrives, or
/// when stopped. Not complete: that nothing is found is no proof that there is nothing.
/// Deterministic. O(steps x people x cells within a step of two people)
[[nodiscard]] std::optional<Passing> pass(const PassTask& task, const Progress& progress);

}  // namespace footlight::planner
