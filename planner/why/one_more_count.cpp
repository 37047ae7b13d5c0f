// SPDX-License-Identifier: Apache-2.0
#include "planner/why/one_more_count.hpp"

#include <algorithm>
#include <numeric>

#include "core/check.hpp"
#include "planner/casting.hpp"
#include "planner/judge/approach.hpp"
#include "planner/schedule/chain.hpp"
#include "planner/validate.hpp"
#include "planner/why/drawn.hpp"

namespace footlight::planner {
namespace {

constexpr double kMostLag_s = 2.0;
/// Formations after the one that was asked for that are solved with it, so that people set out in time.
constexpr std::size_t kOnward = 6;

class OneTransition {
 public:
  OneTransition(const Show& show, const Plan& plan, const Drawn& drawn, PerformerIndex who, FormationIndex into)
      : show_(show), plan_(plan), drawn_(drawn), who_(who), into_(into), limits_(show) {
    // The plan gives slow people slow tracks; what one transition needs is the section's limit.
    for (Performer& performer : limits_.performers) performer.max_speed_mps = 0;
  }

  [[nodiscard]] MoveFigures figures(const Plan& plan, Instant start, Instant end) const {
    MoveFigures out;
    const Grid& grid = plan.stage.grid;
    const CellFlags places = drawn_.places(drawn_.number_of(into_));
    for (std::size_t p = 0; p < plan.tracks.size(); ++p) {
      const std::vector<Mark> way = way_of(plan.tracks[p], start, end);
      FL_CHECK(!way.empty());
      double walk_m = 0;
      double fastest_mps = 0;
      for (std::size_t k = 1; k < way.size(); ++k) {
        const double piece_m = distance(grid.centre(way[k - 1].cell), grid.centre(way[k].cell));
        walk_m += piece_m;
        fastest_mps = std::max(fastest_mps, piece_m / to_seconds(way[k].time - way[k - 1].time));
      }
      out.total_walk_m += walk_m;
      out.fastest_mps = std::max(out.fastest_mps, fastest_mps);
      const double own = plan.max_speed_mps[p];
      const double limit = own > 0 ? own : plan_.sections[plan_.formations[into_.at()].section.at()].max_speed_mps;
      out.too_fast += fastest_mps > limit * (1 + judge::kSpeedTolerance) ? 1 : 0;
      out.places_reached += places[way.back().cell.at()] != 0 ? 1 : 0;
      if (p != who_.at()) continue;
      out.to = way.back().cell;
      out.walk_m = walk_m;
      out.speed_mps = fastest_mps;
    }
    out.clearance_m = closest_approach(plan, start, end).distance_m;
    out.tolerated_lag_s = tolerated_lag_s(plan, start, end, kMostLag_s);
    return out;
  }

  /// The transition, and a few after it, with so many counts more.
  [[nodiscard]] Result<MoveFigures> solve(double more_counts, const Progress& progress) const {
    const std::vector<Station> stations = stations_with(more_counts);
    auto casting = casting_of(limits_, stations);
    if (!casting) return casting.error();
    // Everybody is somebody already, where she stands now.
    casting->bindings.resize(stations.size());
    Binding& here = casting->bindings.front();
    here.person.resize(plan_.tracks.size());
    std::iota(here.person.begin(), here.person.end(), 0U);
    here.place = here.person;
    const ChainTask task{&limits_, &drawn_.ways(), &stations, &*casting, plan_.stage.clearance_m};
    const auto chain = walk_through(task, progress);
    if (!chain) return Error{ErrorKind::interrupted, "stopped while solving a transition again"};
    return figures(plan_from(*chain), stations[0].depart, stations[1].arrive);
  }

 private:
  [[nodiscard]] std::vector<Station> stations_with(double more_counts) const {
    Station here;
    here.section = plan_.formations[into_.at() - 1].section;
    here.arrive = here.depart = start_of_move(plan_, into_);
    here.count = show_.tempo.count_at(here.depart);
    here.cells = plan_.formations[into_.at() - 1].cells;
    here.exact = true;
    std::vector<Station> stations{here};
    const std::size_t first = drawn_.number_of(into_);
    for (std::size_t n = first; n < std::min(drawn_.formations(), first + 1 + kOnward); ++n) {
      Station station = drawn_.station(n);
      if (more_counts != 0) {
        station.count = show_.tempo.count_at(station.arrive) + more_counts;
        station.arrive = station.depart = show_.tempo.at(station.count);
      }
      stations.push_back(std::move(station));
    }
    return stations;
  }

  /// A plan of these walks alone, people in the order of the show.
  [[nodiscard]] Plan plan_from(const Chain& chain) const {
    Plan out;
    out.stage = plan_.stage;
    out.performers = plan_.performers;
    out.radius_m = plan_.radius_m;
    out.max_speed_mps = plan_.max_speed_mps;
    out.tracks.resize(plan_.tracks.size());
    for (std::uint32_t p = 0; p < out.tracks.size(); ++p) {
      std::uint32_t slot = chain.first_place[p];
      for (std::size_t k = 0; k < chain.stops.size(); ++k) {
        const Stop& stop = chain.stops[k];
        Instant arrive = stop.arrive;
        if (k > 0) {
          arrive = chain.walk_times(k - 1, slot).end;
          slot = chain.legs[k - 1].target_of[slot];
        }
        const CellIndex cell = stop.cells[slot];
        out.tracks[p].push_back({arrive, cell});
        const Instant depart = k < chain.legs.size() ? chain.walk_times(k, slot).start : stop.depart;
        if (depart > arrive) out.tracks[p].push_back({depart, cell});
        if (k == chain.legs.size()) continue;
        for (const Mark& mark : chain.marks_on_the_way(k, slot)) out.tracks[p].push_back(mark);
      }
    }
    return out;
  }

  const Show& show_;
  const Plan& plan_;
  const Drawn& drawn_;
  PerformerIndex who_;
  FormationIndex into_;
  Show limits_;
};

}  // namespace

Result<OneMoreCount> one_more_count(const Show& show, const Plan& plan, const std::optional<Film>& film,
                                    PerformerIndex who, FormationIndex into, const Progress& progress) {
  const Show present = show_of_those_who_come(show, plan);
  const Drawn drawn(present, plan, film, plan.formations[into.at()].section);
  const OneTransition transition(present, plan, drawn, who, into);
  OneMoreCount out;
  const CellFlags places = drawn.places(drawn.number_of(into));
  out.places = static_cast<int>(std::count(places.begin(), places.end(), 1));
  out.planned = transition.figures(plan, start_of_move(plan, into), plan.formations[into.at()].time);
  auto again = transition.solve(0, progress);
  if (!again) return again.error();
  auto one_more = transition.solve(1, progress);
  if (!one_more) return one_more.error();
  out.again = *again;
  out.one_more = *one_more;
  return out;
}

}  // namespace footlight::planner
