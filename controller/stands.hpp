// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/plan.hpp"

namespace footlight::controller {

/// When everybody stands on a cell: only there may a show stop for long, and only from there and to there can people be
/// sent somewhere else.
class Stands {
 public:
  /// O(M log M) for M marks
  explicit Stands(const Plan& plan);

  /// The first instant from `position` on at which nobody walks. @param waits nobody has begun the walk of that very
  /// instant
  [[nodiscard]] Instant from(Instant position, bool waits) const noexcept;
  /// What comes after a stand.
  struct Rest {
    Duration stands{};         ///< nobody walks for so long
    Duration shortest_walk{};  ///< of those that then begin before everybody stands again
  };
  /// Nothing: nobody walks any more. @param stand as `from` says
  [[nodiscard]] std::optional<Rest> rest(Instant stand) const noexcept;
  /// The last one up to `position`; those who begin to walk there have not begun.
  [[nodiscard]] Instant until(Instant position) const noexcept;

 private:
  struct Walking {
    Instant begins;
    Instant ends;
    Duration shortest;  ///< of the walks in it
  };
  std::vector<Walking> walking_;  ///< ascending; one may begin where the one before ends
};

/// Everybody's cell at an instant at which nobody walks. O(performers log marks)
[[nodiscard]] std::vector<CellIndex> cells_at(const Plan& plan, Instant stand);

}  // namespace footlight::controller
