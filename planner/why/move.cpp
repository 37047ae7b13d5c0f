// SPDX-License-Identifier: Apache-2.0
#include "planner/why/move.hpp"

#include <algorithm>
#include <limits>

#include "core/check.hpp"
#include "planner/judge/approach.hpp"
#include "planner/judge/blocked.hpp"
#include "planner/validate.hpp"
#include "planner/why/drawn.hpp"

namespace footlight::planner {
namespace {

constexpr double kMostLag_s = 2.0;

/// The plan of some of its people, for questions about them.
Plan plan_of_two(const Plan& plan, std::uint32_t a, std::uint32_t b) {
  Plan out;
  out.stage = plan.stage;
  for (const std::uint32_t person : {a, b}) {
    out.performers.push_back(plan.performers[person]);
    out.radius_m.push_back(plan.radius_m[person]);
    out.max_speed_mps.push_back(plan.max_speed_mps[person]);
    out.tracks.push_back(plan.tracks[person]);
  }
  return out;
}

class Explainer {
 public:
  Explainer(const Show& show, const Plan& plan, const Drawn& drawn, PerformerIndex who, FormationIndex into)
      : show_(show), plan_(plan), drawn_(drawn), who_(who), section_(plan.formations[into.at()].section) {
    FL_CHECK(who.at() < plan.tracks.size());
    move_.into = into;
    move_.start = start_of_move(plan, into);
    move_.end = plan.formations[into.at()].time;
  }

  Move run() {
    walk();
    limit();
    neighbours();
    blocked_cells();
    const Section& section = show_.sections[section_.at()];
    bindings(section);
    move_.film_sets_time =
        std::holds_alternative<VideoSource>(section.from) && plan_.formations[move_.into.at() - 1].section == section_;
    return move_;
  }

 private:
  void walk() {
    const Grid& grid = plan_.stage.grid;
    way_ = way_of(plan_.tracks[who_.at()], move_.start, move_.end);
    FL_CHECK(!way_.empty());
    move_.from = way_.front().cell;
    move_.to = way_.back().cell;
    for (std::size_t k = 1; k < way_.size(); ++k) {
      const double walk_m = distance(grid.centre(way_[k - 1].cell), grid.centre(way_[k].cell));
      move_.walk_m += walk_m;
      move_.fastest_mps = std::max(move_.fastest_mps, walk_m / to_seconds(way_[k].time - way_[k - 1].time));
    }
  }

  /// Names bind before groups do.
  void bindings(const Section& section) {
    const Station& station = drawn_.station(drawn_.number_of(move_.into));
    move_.exact = station.exact;
    move_.moved = station.moved;
    const auto* list = std::get_if<CellsSource>(&section.from);
    for (const auto& [performer, cell] : station.pins) {
      if (performer == who_) move_.pinned_to = cell;
    }
    const auto& group = show_.performers[who_.at()].group;
    const bool in_region = group && std::any_of(section.regions.begin(), section.regions.end(),
                                                [&](const Region& region) { return region.group == *group; });
    if (station.pinned) {
      move_.bound = Move::Bound::list;
    } else if (move_.pinned_to) {
      move_.bound = Move::Bound::pin;
    } else if (list != nullptr && !list->groups.empty()) {
      move_.bound = Move::Bound::group_in_list;
    } else if (in_region) {
      move_.bound = Move::Bound::region;
    } else if (group && !show_.groups[group->at()].exchange) {
      move_.bound = Move::Bound::group;
    }
    move_.group = group;
  }

  void limit() {
    const Section& section = show_.sections[section_.at()];
    move_.limit_mps = plan_.sections[section_.at()].max_speed_mps;
    move_.whose_limit = section.max_speed_mps ? Move::SpeedLimit::section : Move::SpeedLimit::stage;
    if (plan_.max_speed_mps[who_.at()] > 0) {
      move_.limit_mps = plan_.max_speed_mps[who_.at()];
      move_.whose_limit = Move::SpeedLimit::own;
    }
  }

  void neighbours() {
    move_.tolerated_lag_s = kMostLag_s;
    const double own_mps = fastest_of(who_.value());
    double slack = std::numeric_limits<double>::infinity();
    for (std::uint32_t other = 0; other < plan_.tracks.size(); ++other) {
      if (other == who_.value()) continue;
      const Plan two = plan_of_two(plan_, who_.value(), other);
      const ClosestApproach near = closest_approach(two, move_.start, move_.end);
      const double least_m = judge::least_distance_m(plan_, who_.value(), other);
      if (near.distance_m - least_m < slack) {
        slack = near.distance_m - least_m;
        move_.nearest = Move::Neighbour{PerformerIndex(other), near.distance_m, least_m, near.at};
      }
      // Who is late by L is at most L times the speed from where she would be.
      const double late_m = move_.tolerated_lag_s * std::min(own_mps, fastest_of(other));
      if (near.distance_m - late_m > least_m) continue;
      const double lag_s = tolerated_lag_s(two, move_.start, move_.end, kMostLag_s);
      if (lag_s >= move_.tolerated_lag_s) continue;
      move_.tolerated_lag_s = lag_s;
      move_.lag_limited_by = PerformerIndex(other);
    }
  }

  /// Largest speed from the move's start until whoever is late has stopped, m/s.
  [[nodiscard]] double fastest_of(std::uint32_t person) const {
    const std::vector<Mark>& track = plan_.tracks[person];
    const Instant late = move_.end + seconds(kMostLag_s);
    double fastest = 0;
    for (std::size_t k = 1; k < track.size(); ++k) {
      if (track[k].time <= move_.start || track[k - 1].time >= late) continue;
      const Grid& grid = plan_.stage.grid;
      fastest = std::max(fastest, distance(grid.centre(track[k - 1].cell), grid.centre(track[k].cell)) /
                                      to_seconds(track[k].time - track[k - 1].time));
    }
    return fastest;
  }

  void blocked_cells() {
    if (plan_.stage.blocked.empty()) return;
    const judge::BlockedFloor floor(plan_.stage);
    const Grid& grid = plan_.stage.grid;
    const double least_m = plan_.stage.clearance_m / 2;
    for (std::size_t k = 0; k < way_.size(); ++k) {
      const Point from = grid.centre(way_[k == 0 ? 0 : k - 1].cell);
      for (const auto& hit : floor.nearer_than(from, grid.centre(way_[k].cell), least_m + grid.pitch_m())) {
        if (move_.blocked && move_.blocked->distance_m <= hit.distance_m) continue;
        move_.blocked = Move::BlockedCell{hit.cell, hit.distance_m, least_m};
      }
    }
  }

  const Show& show_;
  const Plan& plan_;
  const Drawn& drawn_;
  PerformerIndex who_;
  SectionIndex section_;
  std::vector<Mark> way_;
  Move move_;
};

/// The nearest place of the drawing, from where she comes, on which nobody stands.
std::optional<Move::FreePlace> free_place(const Plan& plan, const CellFlags& places, const Move& move) {
  if (places[move.to.at()] != 0) return std::nullopt;
  CellFlags taken(places.size(), 0);
  for (const CellIndex cell : plan.formations[move.into.at()].cells) taken[cell.at()] = 1;
  const Grid& grid = plan.stage.grid;
  std::optional<Move::FreePlace> best;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i] == 0 || taken[i] != 0) continue;
    const double away_m = distance(grid.centre(move.from), grid.centre(CellIndex::of(i)));
    if (!best || away_m < best->away_m) best = Move::FreePlace{CellIndex::of(i), away_m};
  }
  return best;
}

}  // namespace

std::vector<Move> explain_moves(const Show& show, const Plan& plan, const std::optional<Film>& film, PerformerIndex who,
                                FormationIndex first, FormationIndex last) {
  FL_CHECK(first.at() > 0 && last.at() < plan.formations.size());
  const Show present = show_of_those_who_come(show, plan);
  const Drawn drawn(present, plan, film, plan.formations[first.at()].section);
  std::vector<Move> moves;
  for (std::size_t k = first.at(); k <= last.at(); ++k) {
    const FormationIndex into = FormationIndex::of(k);
    FL_CHECK(plan.formations[k].section == plan.formations[first.at()].section);
    moves.push_back(Explainer(present, plan, drawn, who, into).run());
    moves.back().free_place = free_place(plan, drawn.places(drawn.number_of(into)), moves.back());
  }
  return moves;
}

}  // namespace footlight::planner
