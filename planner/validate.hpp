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
    into_blocked,     ///< a walk nearer to a blocked cell than half of the clearance, or the body's radius
    into_obstacle,    ///< the same of an obstacle that moves through the section
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

/// Judges a plan by its marks alone, in closed form, and shares no code with the planner that made it.
///
/// Walks and clearances are exact (tolerances: 1e-6 m of clearance, 1e-6 of speed, 1e-9 m from blocked cells); every
/// pair nearer than 1.5 x its limit is measured, and min_clearance_m is the smallest of the whole show. A clearance is
/// the stage's or the sum of two people's radii where that is more; a speed limit is the person's own, else that of the
/// section in which the walk ends (a walk between two sections ends in the later one), else the stage's. A pair too
/// close is counted once for each stretch between neighbouring mark instants, whoever's marks they are.
///
/// @param plan performers, radius_m, max_speed_mps and tracks of one length; everything else may be wrong
/// Complexity: O(M log M + near pairs) for M marks. Uses all cores; the result does not depend on how many. Thread:
/// reentrant.
[[nodiscard]] Verdict validate(const Plan& plan);

/// The same of a stretch of the show: everybody has to be there from `start` to `end`, and walks that reach into it are
/// judged as a whole, clearances only within it. @param start, end start <= end
/// Complexity: O(M + N log marks + near pairs). Thread: reentrant.
[[nodiscard]] Verdict validate(const Plan& plan, Instant start, Instant end);

/// The two people who come nearest to each other in a stretch of the show.
struct ClosestApproach {
  double distance_m = 0;  ///< infinity for fewer than two people
  PerformerIndex a;
  PerformerIndex b;
  Instant at;
};

/// Exact, in closed form; the earliest, then the first people among equals. @param start, end start <= end
/// Complexity: O(N log marks + near pairs). Thread: reentrant.
[[nodiscard]] ClosestApproach closest_approach(const Plan& plan, Instant start, Instant end);

/// Largest lateness L up to `cap_s` with which everybody may independently start and stop late by up to L without a
/// pair coming nearer than its clearance; 0 when it does without anybody being late.
///
/// Being late by l is walking one's way at s = t - l: all pairs of times (s, u) with |s - u| <= L are looked at of
/// which the earlier lies in [start, end]; the later may lie in the next stretch, where one is still arriving and the
/// other leaves already. Closed form for a pair, to cap_s / 2^20, rounded down. Falls when clearance or speeds rise.
/// Complexity: O(N log marks + near pairs). Deterministic. Thread: reentrant.
/// @param start, end start <= end  @param cap_s >= 0
[[nodiscard]] double tolerated_lag_s(const Plan& plan, Instant start, Instant end, double cap_s = 2.0);

}  // namespace footlight::planner
