// SPDX-License-Identifier: Apache-2.0
#include "app/paper/part.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "app/export_files.hpp"
#include "planner/judge/geometry.hpp"
#include "planner/judge/near_pairs.hpp"

namespace footlight::app {
namespace {

constexpr double kSamePace_mps = 1e-6;

/// Whether somebody walks straight through the middle of three marks without changing pace.
bool passes(const Grid& grid, const Mark& before, const Mark& here, const Mark& after) {
  if (before.cell == here.cell || here.cell == after.cell) return false;
  const auto velocity = [&](const Mark& a, const Mark& b) {
    return (1 / to_seconds(b.time - a.time)) * (grid.centre(b.cell) - grid.centre(a.cell));
  };
  return distance(velocity(before, here), velocity(here, after)) < kSamePace_mps;
}

Way way_between(const Show& show, const Grid& grid, const Place& from, const Place& to) {
  Way out;
  out.leave = from.until;
  out.arrive = to.from;
  out.walk = grid.centre(to.cell) - grid.centre(from.cell);
  out.length_m = length(out.walk);
  const double leave = show.tempo.count_at(out.leave);
  const double counts = show.tempo.count_at(out.arrive) - leave;
  int a_count = 1;
  while (a_count < 4 && out.length_m / (counts * a_count) > kLongestStep_m) a_count *= 2;
  out.steps = std::max(1, static_cast<int>(std::lround(counts * a_count)));
  constexpr double kOnTheCount = 1e-6;
  out.left_foot = a_count > 1 || static_cast<std::int64_t>(std::floor(leave + kOnTheCount)) % 2 != 0;
  return out;
}

Part places_of(const Plan& plan, const Show& show, std::size_t performer, const MarkLooks& looks,
               const std::set<Instant>& formations) {
  const Grid& grid = plan.stage.grid;
  const std::vector<Mark>& track = plan.tracks[performer];
  Part out;
  for (std::size_t k = 0; k < track.size(); ++k) {
    if (k > 0 && track[k].cell == track[k - 1].cell) {
      out.back().until = track[k].time;
      continue;
    }
    const bool inner = k > 0 && k + 1 < track.size();
    if (inner && passes(grid, track[k - 1], track[k], track[k + 1]) && !formations.contains(track[k].time)) continue;
    out.push_back({track[k].time, track[k].time, track[k].cell, looks.of(performer, k), {}, {}, {}, {}});
  }
  for (std::size_t i = 0; i + 1 < out.size(); ++i) out[i].way = way_between(show, grid, out[i], out[i + 1]);
  return out;
}

/// Where everybody is, at instants that ascend.
class Positions {
 public:
  explicit Positions(const Plan& plan) : plan_(plan), mark_(plan.tracks.size(), 0) {}

  void at(Instant time, std::vector<Point>& out) {
    out.resize(plan_.tracks.size());
    for (std::size_t p = 0; p < out.size(); ++p) out[p] = position(p, time);
  }

 private:
  Point position(std::size_t p, Instant time) {
    const std::vector<Mark>& track = plan_.tracks[p];
    std::size_t& k = mark_[p];
    while (k + 1 < track.size() && track[k + 1].time <= time) ++k;
    const Grid& grid = plan_.stage.grid;
    const Point from = grid.centre(track[k].cell);
    if (k + 1 == track.size() || time <= track[k].time) return from;
    const double share = to_seconds(time - track[k].time) / to_seconds(track[k + 1].time - track[k].time);
    return from + share * (grid.centre(track[k + 1].cell) - from);
  }

  const Plan& plan_;
  std::vector<std::size_t> mark_;
};

std::vector<Instant> mark_instants(const Plan& plan) {
  std::vector<Instant> out;
  for (const auto& track : plan.tracks) {
    for (const Mark& mark : track) out.push_back(mark.time);
  }
  std::ranges::sort(out);
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

/// Between neighbouring mark instants everybody walks straight: the closest approach is exact there.
void find_encounters(const Plan& plan, std::vector<Part>& parts) {
  const std::vector<Instant> instants = mark_instants(plan);
  planner::judge::NearPairs near;
  Positions positions(plan);
  std::vector<Point> start;
  std::vector<Point> end;
  std::vector<planner::judge::MovingDisc> discs(parts.size());
  std::vector<std::size_t> place(parts.size(), 0);
  if (!instants.empty()) positions.at(instants.front(), end);
  for (std::size_t k = 0; k + 1 < instants.size(); ++k) {
    std::swap(start, end);
    positions.at(instants[k + 1], end);
    for (std::size_t p = 0; p < parts.size(); ++p) {
      discs[p] = {start[p], end[p], kSightPitches / 2 * plan.stage.grid.pitch_m()};
      while (place[p] + 1 < parts[p].size() && parts[p][place[p] + 1].from <= instants[k]) ++place[p];
    }
    const auto meet = [&](std::uint32_t who, std::uint32_t other, double metres, Instant at) {
      Place& here = parts[who][place[who]];
      if (!here.way || here.way->leave > instants[k]) return;
      std::optional<Encounter>& closest = here.way->closest;
      if (closest && closest->distance_m < metres) return;
      const bool first = closest && closest->distance_m == metres &&
                         std::pair(closest->at, closest->who) < std::pair(at, PerformerIndex(other));
      if (!first) closest = Encounter{PerformerIndex(other), metres, at};
    };
    for (const auto& [a, b] : near.find(discs)) {
      const auto nearest = planner::judge::nearest_to_origin(start[b] - start[a], end[b] - end[a]);
      const double metres = std::sqrt(nearest.squared_m2);
      if (metres > kSightPitches * plan.stage.grid.pitch_m()) continue;
      const Instant at = instants[k] + seconds(nearest.share * to_seconds(instants[k + 1] - instants[k]));
      meet(a, b, metres, at);
      meet(b, a, metres, at);
    }
  }
}

/// Finds people by where they are at one instant.
class Neighbourhood {
 public:
  Neighbourhood(const Grid& grid, const std::vector<Point>& positions)
      : grid_(grid), positions_(positions), on_cell_(static_cast<std::size_t>(grid.size())) {
    for (std::size_t p = 0; p < positions.size(); ++p) on_cell_[grid.nearest(positions[p]).at()].push_back(p);
  }

  void look_around(std::size_t who, Place& place) const {
    const Point here = positions_[who];
    double best[3];
    std::fill_n(best, 3, std::numeric_limits<double>::infinity());
    std::optional<PerformerIndex>* found[3] = {&place.left, &place.right, &place.ahead};
    for (const CellIndex cell : grid_.within(here, kSightPitches * grid_.pitch_m())) {
      for (const std::size_t other : on_cell_[cell.at()]) {
        const Point d = positions_[other] - here;
        if (other == who) continue;
        // Within 45 degrees of that side; what is between two sides belongs to left and right.
        const int side = std::abs(d.x) >= std::abs(d.y) ? (d.x > 0 ? 0 : 1) : (d.y < 0 ? 2 : -1);
        if (side < 0 || squared_length(d) >= best[side]) continue;
        best[side] = squared_length(d);
        *found[side] = PerformerIndex::of(other);
      }
    }
  }

 private:
  const Grid& grid_;
  const std::vector<Point>& positions_;
  std::vector<std::vector<std::size_t>> on_cell_;
};

void find_neighbours(const Plan& plan, std::vector<Part>& parts) {
  std::vector<std::pair<Instant, std::pair<std::size_t, std::size_t>>> asked;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    for (std::size_t i = 0; i < parts[p].size(); ++i) asked.push_back({parts[p][i].from, {p, i}});
  }
  std::ranges::sort(asked);
  Positions positions(plan);
  std::vector<Point> where;
  for (std::size_t i = 0; i < asked.size();) {
    const Instant time = asked[i].first;
    positions.at(time, where);
    const Neighbourhood around(plan.stage.grid, where);
    for (; i < asked.size() && asked[i].first == time; ++i) {
      const auto [p, place] = asked[i].second;
      around.look_around(p, parts[p][place]);
    }
  }
}

}  // namespace

std::vector<Part> parts_of(const Plan& plan, const Show& show) {
  const MarkLooks looks(plan);
  std::set<Instant> formations;
  for (const Formation& formation : plan.formations) formations.insert(formation.time);
  std::vector<Part> out;
  for (std::size_t p = 0; p < plan.tracks.size(); ++p) out.push_back(places_of(plan, show, p, looks, formations));
  find_encounters(plan, out);
  find_neighbours(plan, out);
  return out;
}

}  // namespace footlight::app
