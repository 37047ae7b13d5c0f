// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/grid.hpp"

namespace footlight::planner {

/// Cost of walking from a source to a target.
enum class WalkCost { squared, euclidean };

/// A perfect matching of sources to targets and the proof that it is the cheapest.
struct Assignment {
  std::vector<std::uint32_t> target_of;  ///< for each source
  double cost = 0;                       ///< sum over the pairs, m^2 or m
  /// cost minus the value of the dual solution found with it: 0 for squared cost (exact integer arithmetic on lattice
  /// points), within rounding (1e-9 relative) for Euclidean cost.
  double gap = 0;
  /// The dual solution, m^2 or m: source_value[i] + target_value[j] <= cost of every allowed pair, with equality for
  /// the matched ones, so that the sum of both is a lower bound of any assignment's cost, and is cost - gap.
  std::vector<double> source_value;
  std::vector<double> target_value;
  std::uint64_t looked_at = 0;  ///< pairs that the exact finish has looked at: how good its start was
};

/// The cheapest one-to-one assignment of N sources to N targets, exact.
///
/// @param sources, targets  N distinct points each, metres, |coordinate| < 1e5
/// @param longest_m  walks longer than this are forbidden (infinity: none are)
/// @param stop becomes true when the answer is no longer wanted; may be missing
/// @return nothing when no assignment without forbidden walks exists; or none was found in bounded work, which happens
/// to tens of thousands whose longest walk can hardly be shorter; or when stopped
/// Complexity and method: docs/algorithms/assignment.md. Deterministic. Thread: reentrant.
[[nodiscard]] std::optional<Assignment> assign(std::span<const Point> sources, std::span<const Point> targets,
                                               WalkCost cost, double longest_m,
                                               const std::atomic<bool>* stop = nullptr);

/// The same over an explicit list of allowed pairs with any cost: blocked ways, penalties, pins.
struct Arc {
  std::uint32_t source = 0;
  std::uint32_t target = 0;
  double cost = 0;  ///< finite
};
/// @param arcs sorted by source, then target, without doubles
[[nodiscard]] std::optional<Assignment> assign_sparse(std::uint32_t size, std::span<const Arc> arcs);

}  // namespace footlight::planner
