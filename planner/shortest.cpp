// SPDX-License-Identifier: Apache-2.0
#include "planner/shortest.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace footlight::planner {
namespace {

/// The move that leaves the least time.
struct Tightest {
  double factor = 0;  ///< of the section's duration
  std::size_t slot = 0;
  std::size_t from = 0;  ///< stop
  std::size_t to = 0;
};

/// Somebody who stands on a cell at an instant.
std::string who_is_at(const Plan& plan, CellIndex cell, Instant instant) {
  for (std::size_t p = 0; p < plan.tracks.size(); ++p) {
    if (distance(position_at(plan.stage.grid, plan.tracks[p], instant), plan.stage.grid.centre(cell)) < 1e-6) {
      return "performer " + plan.performers[p];
    }
  }
  return "somebody";
}

}  // namespace

std::optional<Planned::Shortest> shortest_duration(const Show& show, const Chain& chain, SectionIndex section,
                                                   const Plan& plan) {
  const Section& asked = show.sections[section.at()];
  // A model of motion takes all the time that there is.
  if (asked.motion != nullptr) return std::nullopt;
  // Steps over cells are counted and not measured: `refusal` tells how many are missing.
  if (show.stage.walk == WalkKind::cells) return std::nullopt;
  // Planned together with its walks a drawing asks for nothing that takes longer than there is.
  const auto& film = plan.sections[section.at()].film;
  if (asked.planner.model == PlannerModel::joint && film && film->show_fps > 0) return std::nullopt;
  const Grid& grid = show.stage.grid;
  const double speed = section_speed(show, asked);
  std::vector<char> waits(static_cast<std::size_t>(grid.size()), 0);
  for (const CellIndex cell : show.stage.reserve) waits[cell.at()] = 1;
  Tightest tightest;
  std::vector<std::size_t> last;  // for each slot the stop from which the way to the next place in the picture begins
  for (std::size_t k = 0; k < chain.stops.size(); ++k) {
    const Stop& stop = chain.stops[k];
    if (stop.section != section || !stop.station) continue;
    if (last.empty()) {
      last.assign(stop.own.size(), k);
      continue;
    }
    const auto from_cells = [&](std::size_t j) -> const std::vector<CellIndex>& {
      return chain.stops[j].exact ? chain.stops[j].cells : chain.stops[j].own;
    };
    for (std::size_t i = 0; i < stop.own.size(); ++i) {
      if (waits[stop.own[i].at()] != 0) continue;
      const Stop& begin = chain.stops[last[i]];
      const double walk_m = distance(grid.centre(from_cells(last[i])[i]), grid.centre(stop.own[i]));
      const double factor = walk_m / (speed * to_seconds(stop.arrive - begin.depart));
      if (factor > tightest.factor) tightest = {factor, i, last[i], k};
      last[i] = k;
    }
    if (stop.exact) last.assign(stop.own.size(), k);
  }
  if (tightest.factor <= 0 || asked.duration_counts <= 0) return std::nullopt;
  const Stop& from = chain.stops[tightest.from];
  const Stop& to = chain.stops[tightest.to];
  const CellIndex begin = from.exact ? from.cells[tightest.slot] : from.own[tightest.slot];
  const CellIndex end = to.own[tightest.slot];
  Planned::Shortest shortest;
  shortest.counts = std::ceil(asked.duration_counts * tightest.factor);
  shortest.limited_by = fmt::format("{} from {} to {}, {:.1f} m between count {:g} and count {:g}",
                                    who_is_at(plan, begin, from.depart), grid.name(begin), grid.name(end),
                                    distance(grid.centre(begin), grid.centre(end)), from.count, to.count);
  return shortest;
}

}  // namespace footlight::planner
