// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/plan.hpp"
#include "planner/plan_section.hpp"
#include "planner/schedule/cast_tracks.hpp"
#include "planner/schedule/walks.hpp"
#include "planner/stages.hpp"

namespace footlight::planner {

/// All formations of a show, one after the other.
struct ChainTask {
  const Show* show = nullptr;
  const Ways* ways = nullptr;
  const std::vector<Station>* stations = nullptr;
  const Casting* casting = nullptr;  ///< nothing: anybody may stand anywhere
  double clearance_m = 0.5;          ///< that holds for every two people
  Stages* stages = nullptr;          ///< of an earlier planning; nothing: all of it is planned anew
  struct Counts {
    StageCount pairings;
    StageCount walks;
  };
  Counts* counts = nullptr;  ///< of stages, to add to
};

/// An instant at which everybody stands on a cell.
struct Stop {
  double count = 1;
  Instant arrive;
  Instant depart;
  std::optional<std::size_t> station;  ///< absent: on the way around blocked cells
  SectionIndex section;                ///< whose limits hold on the way here
  /// A slot is a place in the formations that one person at a time fills. Slots are numbered anew at every exact
  /// formation, in the order of the station's cells, so that what follows depends on nothing before it.
  bool exact = false;
  std::vector<CellIndex> own;    ///< ideal cell of each slot, numbered as before; empty on the way
  std::vector<CellIndex> cells;  ///< of each slot, as it can be walked, numbered as from here on; distinct
  int given_way = 0;             ///< slots in the picture whose cell is not the own one
};

/// Who goes where: position 0.. in `cells` of one stop -> position in `cells` of the next.
struct Chain {
  std::vector<Stop> stops;
  std::vector<Leg> legs;                   ///< one less than stops
  std::vector<double> longest_m;           ///< for each leg, how far anybody may walk
  std::vector<std::uint32_t> first_place;  ///< of each performer in the first stop's `cells`
  std::vector<std::uint32_t> alike;  ///< of each performer: people with equal numbers may have each other's tracks

  /// A change to an exact formation for which marks were put on the way, so that people pass each other.
  struct Passed {
    std::size_t first_stop = 0;
    std::size_t last_stop = 0;
    double straight_m = 0;  ///< of all walks without these marks
    double walked_m = 0;    ///< with them
  };
  std::vector<Passed> passed;
  /// A change to an exact formation that could not be made.
  struct Unpassed {
    std::size_t leg = 0;                ///< the first on the way there
    double given_s = 0;                 ///< the time there is
    std::optional<double> needed_s;     ///< that would do; nothing when no way was found
    std::optional<std::uint32_t> last;  ///< who would arrive last then, if that is known: place in the leg's first stop
  };
  std::vector<Unpassed> unpassed;

  /// When somebody walks from stop `leg` to the next; the others of the leg may walk at other times.
  struct WalkTimes {
    Instant start;
    Instant end;
  };
  [[nodiscard]] WalkTimes walk_times(std::size_t leg, std::uint32_t slot) const;
  /// Between the two, hers alone.
  [[nodiscard]] std::vector<Mark> marks_on_the_way(std::size_t leg, std::uint32_t slot) const;
};

/// From formations to walks: ideal pairings of neighbours (parallel where nobody is bound), slots from each exact
/// formation to the next, pace, snap, and for each interval the final pairing, in which people of one kind may take
/// each other's targets; stretches between exact formations are independent (parallel). At the end people are named so
/// that every binding is kept.
/// @return nothing when stopped. Byte-equal for any number of threads.
[[nodiscard]] std::optional<Chain> walk_through(const ChainTask& task, const Progress& progress);

}  // namespace footlight::planner
