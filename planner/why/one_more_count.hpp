// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/film.hpp"
#include "core/plan.hpp"
#include "core/result.hpp"
#include "core/show.hpp"
#include "planner/progress.hpp"

namespace footlight::planner {

/// What everybody's walks into one formation come to.
struct MoveFigures {
  CellIndex to;          ///< of the performer who was asked for
  double walk_m = 0;     ///< hers
  double speed_mps = 0;  ///< her fastest walk
  double total_walk_m = 0;
  double fastest_mps = 0;
  double clearance_m = 0;      ///< smallest; infinity for one performer alone
  double tolerated_lag_s = 0;  ///< of everybody, at most 2 s
  int too_fast = 0;            ///< people above their limit
  int places_reached = 0;      ///< of the drawing
};

/// The walks into a formation as planned, solved again between the same places, and solved with one more count.
/// `again` shows what is due to solving this one transition on its own.
struct OneMoreCount {
  int places = 0;  ///< of the drawing that can be reached: cells outside of the reserve
  MoveFigures planned;
  MoveFigures again;
  MoveFigures one_more;
};

/// Solves the walks from where people stand in the formation before to the drawing of this one (of its section's
/// later ones, too, a few of them, so that people set out in time), with the time there is and with one count more.
/// The drawing is that of the formation's own frame, whatever the model: who can stand in the picture when nobody has
/// to come from anywhere (planner/formation).
/// @return interrupted when stopped. Complexity: that of planning a few formations.
[[nodiscard]] Result<OneMoreCount> one_more_count(const Show& show, const Plan& plan, const std::optional<Film>& film,
                                                  PerformerIndex who, FormationIndex into, const Progress& progress);

}  // namespace footlight::planner
