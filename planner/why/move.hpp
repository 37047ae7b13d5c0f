// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/film.hpp"
#include "core/plan.hpp"
#include "core/show.hpp"

namespace footlight::planner {

/// One performer's way into one formation, and everything that could limit it.
struct Move {
  FormationIndex into;
  Instant start;  ///< when the formation before is left
  Instant end;    ///< when this one stands
  CellIndex from;
  CellIndex to;
  double walk_m = 0;       ///< along all marks between
  double fastest_mps = 0;  ///< of the walks between those marks

  enum class SpeedLimit { own, section, stage };
  double limit_mps = 0;  ///< the one that holds for her
  SpeedLimit whose_limit = SpeedLimit::stage;
  bool film_sets_time = false;  ///< the key frames do; else the show file: where sections begin and end

  /// Who comes nearest to her, and when. Closed form.
  struct Neighbour {
    PerformerIndex who;
    double distance_m = 0;
    double least_m = 0;  ///< that the two must keep
    Instant at;
  };
  std::optional<Neighbour> nearest;  ///< absent for one performer alone
  /// Largest lateness of hers and anybody's, independently, without coming too close, at most 2 s; and to whom first.
  double tolerated_lag_s = 0;
  std::optional<PerformerIndex> lag_limited_by;  ///< absent when 2 s are tolerated

  struct BlockedCell {
    CellIndex cell;
    double distance_m = 0;  ///< of its outline from her way
    double least_m = 0;
  };
  std::optional<BlockedCell> blocked;  ///< the one nearest to her way, where it is no more than a pitch from the limit
  /// What keeps others off her place there, or her off theirs.
  enum class Bound { nothing, list, pin, group_in_list, region, group };
  Bound bound = Bound::nothing;
  std::optional<GroupIndex> group;     ///< hers, where that is what binds her
  std::optional<CellIndex> pinned_to;  ///< by hand, though the walk may not reach it
  bool exact = false;                  ///< nobody may be elsewhere in the formation
  int moved = 0;                       ///< people in it whom the director put elsewhere by hand

  /// A free place of the drawing when she stands on none: the nearest to where she came from.
  struct FreePlace {
    CellIndex cell;
    double away_m = 0;
  };
  std::optional<FreePlace> free_place;

  [[nodiscard]] double time_s() const { return to_seconds(end - start); }
};

/// The performer's ways into the formations [first, last] of one section, in their order. The first formation of a show
/// cannot be asked for: nobody walks into the opening form.
/// @param film of the section where it has one
/// Complexity: O(moves x people x marks of a move + the section's pictures). Thread: reentrant.
[[nodiscard]] std::vector<Move> explain_moves(const Show& show, const Plan& plan, const std::optional<Film>& film,
                                              PerformerIndex who, FormationIndex first, FormationIndex last);

}  // namespace footlight::planner
