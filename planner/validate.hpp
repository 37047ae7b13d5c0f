// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/plan.hpp"

namespace footlight::planner {

/// One broken limit.
struct Violation {
  enum class Kind {
    times,  ///< not increasing, or not there from the first to the last instant
    off_grid,
    blocked_cell,
    same_cell,  ///< two people on one cell
    too_close,  ///< nearer than the clearance while walking or standing
    too_fast,
    into_blocked,     ///< a walk nearer to a blocked cell than half of the clearance
    wrong_formation,  ///< a formation differs from the marks of its instant
  };
  Kind kind = Kind::times;
  PerformerIndex a;
  PerformerIndex b;  ///< same_cell, too_close; else equal to a
  Instant time;      ///< of the closest approach, or start of the walk
  double value = 0;  ///< m or m/s found
  double limit = 0;  ///< m or m/s allowed
  std::string text;  ///< for people: names, cells, count-free time, figures
};

struct Verdict {
  std::uint64_t violations = 0;  ///< all of them
  std::vector<Violation> first;  ///< at most 100, ordered by time, then performers
  double min_clearance_m = 0;    ///< over the show, infinity for one performer
  PerformerIndex closest_a;
  PerformerIndex closest_b;
  Instant closest_at;
  std::uint64_t too_close = 0;  ///< pairs and stretches below the clearance
  double max_speed_mps = 0;
  [[nodiscard]] bool valid() const { return violations == 0; }
};

/// Judges a plan by its marks alone, in closed form, and shares no code with the planner that made it. Clearances
/// below 1.5 x the limit are exact; a pair that never comes nearer than that may be passed over. Complexity: O(M log M
/// + near pairs) for M marks. Thread: reentrant.
[[nodiscard]] Verdict validate(const Plan& plan);

/// Largest lateness up to `cap_s` with which everybody may start and stop independently in [start, end] without coming
/// too close.
[[nodiscard]] double tolerated_lag_s(const Plan& plan, Instant start, Instant end, double cap_s = 2.0);

}  // namespace footlight::planner
