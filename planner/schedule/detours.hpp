// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "planner/progress.hpp"
#include "planner/schedule/walks.hpp"

namespace footlight::planner {

/// Walks between two instants of which some conflict.
struct DetourTask {
  const Ways* ways = nullptr;
  std::span<const CellIndex> from;  ///< distinct
  std::span<const CellIndex> to;    ///< distinct; where leg.target_of leads
  double clearance_m = 0.5;
  double speed_mps = 1.4;                 ///< nobody walks faster
  double time_s = 0;                      ///< between the two instants
  double lag_s = 0;                       ///< how late anybody may be; 0: everybody is punctual
  double beat_s = 0.5;                    ///< marks on the way lie on multiples of it
  std::span<const double> radius_m = {};  ///< as LegTask::radius_m
};

/// Sends those who conflict around others with marks of their own on the way; everybody else walks as before, and
/// everybody keeps her target. One after the other looks for the shortest way over cells and beats that is clear of
/// everybody else's walk; where there is none she goes where it costs least, and those who are then in her way look for
/// theirs. Whom she has met often costs more, so that people do not push each other back and forth. At the end marks
/// that nobody needs are left out.
///
/// Source: the idea to keep a solution with conflicts and to plan those who conflict anew against all others until
/// nobody does is MAPF-LNS2's (Li, Chen, Harabor, Stuckey, Koenig 2022), that what is met often becomes dearer
/// PathFinder's (McMurchie, Ebeling 1995); there people take cells, here straight walks that keep their clearance in
/// closed form, also when they are late.
/// @param leg walkable  @return the leg without conflicts (with `lag_s` also without late ones); nothing when none was
/// found in bounded work, or when stopped: no proof that there is none. Deterministic.
[[nodiscard]] std::optional<Leg> detour(const DetourTask& task, const Leg& leg, const Progress& progress);

}  // namespace footlight::planner
