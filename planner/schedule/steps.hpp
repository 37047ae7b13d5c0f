// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "planner/schedule/ways.hpp"

namespace footlight::planner {

/// Everybody goes from cells to cells over neighbouring cells (Grid::neighbours), one cell a step.
struct StepsTask {
  const Ways* ways = nullptr;
  std::span<const CellIndex> from;  ///< distinct, can be stood on
  std::span<const CellIndex> to;    ///< distinct, can be stood on; to[i] is meant for from[i]
  int most_steps = 0;               ///< the schedule is cut after so many
  /// As LegTask::kind: people exchange goals within a kind only. Empty: everybody with everybody.
  std::span<const std::uint32_t> kind = {};
  /// Who follows closely, keeps so far from whoever is ahead though one of them is late by `late_share` of a step; 0:
  /// Grid::clearance_bound_m when nobody is late.
  double clearance_m = 0;
  double late_share = 0;  ///< in [0, 1)
};

/// Who takes which step when.
struct Steps {
  struct Move {
    std::uint32_t person = 0;  ///< position in `from`
    CellIndex cell;            ///< where she is after the step
  };
  std::vector<Move> moves;               ///< step by step; nobody twice in a step
  std::vector<std::uint32_t> first;      ///< of each step in `moves`, and their number at the end
  std::vector<CellIndex> last;           ///< where each person is after the last step
  std::vector<std::uint32_t> target_of;  ///< position in `to` of each person's goal, a bijection
  bool arrived =
      false;  ///< everybody is at a goal; else the steps were too few, or kinds are too much in each other's way

  [[nodiscard]] int count() const { return static_cast<int>(first.size()) - 1; }
};

/// A schedule of steps in which nobody shares a cell, nobody changes places with a neighbour, and no two people come
/// nearer than Grid::clearance_bound_m.
///
/// In each step people are looked at in the order of their first cells, forwards and backwards in turn, and go a cell
/// nearer to their goal. Who is blocked by somebody at her goal exchanges goals with her; who is blocked by somebody
/// who has not been looked at yet has her go first, so that trains move together; a circle of people who block each
/// other exchanges goals around and stays. No exchange makes the sum of the distances to the goals larger, and the
/// person who is looked at first in a step makes it smaller: so it ends, unless kinds block each other, who then push
/// each other aside (`push_aside`); and with pairings of least squared distance
/// mostly after as many steps as the longest way has cells.
///
/// A neighbour who comes to a cell in the step in which its owner leaves it turns by no more than a right angle; on
/// hexagons sharper turns wait, on squares and triangles there are none. With that (s_i - s_j) . (g_i - g_j) >= 0 holds
/// in every step for every pair (docs/algorithms/clearance.md). Two who turn by an angle a on a pitch p, one late by a
/// share l of the step, come as near as p (1 - l) cos(a/2): where that is less than `clearance_m`, the follower waits.
///
/// @return nothing when somebody's goal cannot be reached at all, or the stage with its blocked cells is too large.
/// Distances are closed forms on an open floor, and between blocked cells wherever none lies in the rectangle of a
/// person and her goal (squares); else they are searched for goal by goal. Complexity: O(cells + steps x people), and
/// O(cells) for each goal that is searched. Deterministic.
/// Source: exchanging goals as in TSWAP (Okumura, Defago 2022, "Solving Simultaneous Target Assignment and Path
/// Planning Efficiently with Time-Independent Execution"); priority passed on as in PIBT (Okumura et al. 2019).
[[nodiscard]] std::optional<Steps> step_through(const StepsTask& task);

}  // namespace footlight::planner
