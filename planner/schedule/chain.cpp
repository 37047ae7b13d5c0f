// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/chain.hpp"

#include <algorithm>
#include <cmath>

#include "planner/hierarchy/hierarchical_matching.hpp"
#include "planner/parallel.hpp"
#include "planner/schedule/shift.hpp"
#include "planner/schedule/snap.hpp"

namespace footlight::planner {
namespace {

constexpr double kRounding_m = 1e-9;
/// On the way around blocked cells there is a stop whenever somebody may have walked so many pitches.
constexpr double kViaPitches = 4.5;
/// Rounds in which only one of two people in conflict has to wait.
constexpr int kPatience = 4;
/// Cell by cell around blocked cells: room in each step for the rounding of instants, and steps walked at once.
constexpr double kStepMargin = 1.001;
constexpr std::size_t kStride = 4;

class ChainBuilder {
 public:
  ChainBuilder(const ChainTask& task, const Progress& progress)
      : task_(task),
        progress_(progress),
        ways_(*task.ways),
        grid_(task.ways->grid()),
        stations_(*task.stations),
        reserve_(static_cast<std::size_t>(grid_.size()), 0) {
    for (const CellIndex cell : task.show->stage.reserve) reserve_[cell.at()] = 1;
  }

  std::optional<Chain> run() {
    if (!pair_all()) return std::nullopt;
    follow_slots();
    for (std::size_t s = 0; s < stations_.size(); ++s) add_stop(s);
    if (!pace() || !mend()) return std::nullopt;
    return std::move(chain_);
  }

 private:
  bool pair_all() {
    pairings_.resize(stations_.size() - 1);
    return for_each_index(pairings_.size(), "pairing", progress_,
                          [&](std::size_t k) { pairings_[k] = pair(stations_[k], stations_[k + 1]); });
  }

  /// Who waits in the reserve before and after stays where she is; the others as the section asks for.
  [[nodiscard]] std::vector<std::uint32_t> pair(const Station& from, const Station& to) const {
    std::vector<std::uint32_t> target_of(from.cells.size());
    if (to.follows || (from.pinned && to.pinned)) {
      for (std::uint32_t i = 0; i < target_of.size(); ++i) target_of[i] = i;
      return target_of;
    }
    constexpr std::uint32_t kNone = 0xFFFFFFFFU;
    std::vector<std::uint32_t> waiting(static_cast<std::size_t>(grid_.size()), kNone);
    for (std::uint32_t j = 0; j < to.cells.size(); ++j) {
      if (reserve_[to.cells[j].at()] != 0) waiting[to.cells[j].at()] = j;
    }
    std::vector<CellIndex> sources;
    std::vector<CellIndex> targets;
    std::vector<std::uint32_t> source_at;
    std::vector<std::uint32_t> target_at;
    std::vector<char> stays(to.cells.size(), 0);
    for (std::uint32_t i = 0; i < from.cells.size(); ++i) {
      const std::uint32_t same = waiting[from.cells[i].at()];
      if (same != kNone) {
        target_of[i] = same;
        stays[same] = 1;
      } else {
        sources.push_back(from.cells[i]);
        source_at.push_back(i);
      }
    }
    for (std::uint32_t j = 0; j < to.cells.size(); ++j) {
      if (stays[j] != 0) continue;
      targets.push_back(to.cells[j]);
      target_at.push_back(j);
    }
    const PlannerOptions& options = task_.show->sections[to.section.at()].planner;
    const auto matched = pair_formations(grid_, sources, targets, options);
    for (std::size_t i = 0; i < matched.size(); ++i) target_of[source_at[i]] = target_at[matched[i]];
    return target_of;
  }

  void follow_slots() {
    const std::size_t people = stations_.front().cells.size();
    slots_.assign(stations_.size(), std::vector<CellIndex>(people));
    for (std::uint32_t slot = 0; slot < people; ++slot) {
      std::uint32_t at = slot;
      for (std::size_t s = 0; s < stations_.size(); ++s) {
        slots_[s][slot] = stations_[s].cells[at];
        if (s + 1 < stations_.size()) at = pairings_[s][at];
      }
    }
  }

  void add_stop(std::size_t s) {
    const Station& station = stations_[s];
    if (s > 0) add_vias(s);
    if (s > 0) link(station.section, station.arrive);
    Stop stop;
    stop.count = station.count;
    stop.arrive = station.arrive;
    stop.depart = station.depart;
    stop.station = s;
    stop.section = station.section;
    stop.own = slots_[s];
    chain_.stops.push_back(std::move(stop));
  }

  void link(SectionIndex section, Instant arrive) {
    const Show& show = *task_.show;
    const double speed = section_speed(show, show.sections[section.at()]);
    const double walked_s = to_seconds(arrive - chain_.stops.back().depart);
    chain_.longest_m.push_back(std::max(0.0, speed * walked_s - kRounding_m));
  }

  /// Between two exact formations, where blocked cells are in somebody's way.
  void add_vias(std::size_t s) {
    if (ways_.open() || !stations_[s].exact) return;
    bool straight = true;
    for (std::size_t i = 0; i < slots_[s].size() && straight; ++i) {
      straight = ways_.straight(grid_.centre(slots_[s - 1][i]), grid_.centre(slots_[s][i]));
    }
    const Show& show = *task_.show;
    const Instant start = stations_[s - 1].depart;
    const double total_s = to_seconds(stations_[s].arrive - start);
    const double speed = section_speed(show, show.sections[stations_[s].section.at()]);
    const int pieces = static_cast<int>(std::floor(total_s * speed / (kViaPitches * grid_.pitch_m())));
    if (straight || pieces < 2) return;
    for (int piece = 1; piece < pieces; ++piece) {
      Stop stop;
      stop.arrive = stop.depart = start + seconds(total_s * piece / pieces);
      stop.count = show.tempo.count_at(stop.arrive);
      stop.section = stations_[s].section;
      link(stop.section, stop.arrive);
      chain_.stops.push_back(std::move(stop));
    }
  }

  [[nodiscard]] bool exact(const Stop& stop) const { return stop.station && stations_[*stop.station].exact; }
  [[nodiscard]] bool ends_section(const Stop& stop) const {
    return stop.station && (*stop.station + 1 == stations_.size() ||
                            stations_[*stop.station + 1].section != stations_[*stop.station].section);
  }

  bool pace() {
    std::vector<PaceInstant> instants;
    std::vector<std::size_t> next_formation(chain_.stops.size());
    for (std::size_t k = chain_.stops.size(); k-- > 0;) {
      next_formation[k] = chain_.stops[k].station ? k : next_formation[k + 1];
    }
    for (std::size_t k = 0; k < chain_.stops.size(); ++k) {
      const Stop& stop = chain_.stops[k];
      // On the way everybody heads for the formation at its end.
      instants.push_back({chain_.stops[next_formation[k]].own, exact(stop) || ends_section(stop) || !stop.station,
                          k < chain_.longest_m.size() ? chain_.longest_m[k] : 0.0});
    }
    auto wanted = leave_early(ways_, instants, reserve_);
    chain_.stops.front().cells = chain_.stops.front().own;
    for (std::size_t k = 1; k < chain_.stops.size(); ++k) {
      if (progress_.stopped()) return false;
      progress_.tell("walks", static_cast<double>(k) / static_cast<double>(chain_.stops.size()));
      Stop& stop = chain_.stops[k];
      if (exact(stop)) {
        stop.cells = stop.own;
        chain_.legs.push_back(settle(leg_to(k)));
        continue;
      }
      if (!stop.station) aim_on_the_way(k, next_formation[k], wanted[k]);
      const std::span<const Wanted> onward =
          k + 1 < wanted.size() ? std::span<const Wanted>(wanted[k + 1]) : std::span<const Wanted>();
      step(k, {&ways_,
               chain_.stops[k - 1].cells,
               instants[k].own,
               wanted[k],
               onward,
               chain_.longest_m[k - 1],
               instants[k].longest_m,
               {}});
      for (std::size_t i = 0; i < stop.own.size(); ++i) {
        stop.given_way += stop.cells[i] != stop.own[i] && reserve_[stop.own[i].at()] == 0 ? 1 : 0;
      }
    }
    progress_.tell("walks", 1);
    return true;
  }

  [[nodiscard]] LegTask leg_to(std::size_t k) const {
    return {&ways_, chain_.stops[k - 1].cells, chain_.stops[k].cells, chain_.longest_m[k - 1], task_.clearance_m};
  }

  /// Snaps and pairs; who conflicts waits, and whoever conflicts with those, until nobody does. If all waited nobody
  /// would, so it ends.
  void step(std::size_t k, SnapTask snap_task) {
    std::vector<char> hold(snap_task.now.size(), 0);
    for (int round = 0;; ++round) {
      snap_task.hold = hold;
      chain_.stops[k].cells = snap(snap_task);
      Leg leg = settle(leg_to(k));
      if (leg.conflicts.empty()) {
        chain_.legs.push_back(std::move(leg));
        return;
      }
      bool added = false;
      for (const auto& [a, b] : leg.conflicts) {
        // The one with the shorter walk waits; after a few rounds both do.
        const bool a_waits = walk_m(k, leg, a) <= walk_m(k, leg, b);
        for (const std::uint32_t slot : {a_waits ? a : b, a_waits ? b : a}) {
          if (hold[slot] != 0) continue;
          hold[slot] = 1;
          added = true;
          if (round < kPatience) break;
        }
      }
      if (!added) std::fill(hold.begin(), hold.end(), char{1});
    }
  }

  [[nodiscard]] double walk_m(std::size_t k, const Leg& leg, std::uint32_t slot) const {
    return distance(grid_.centre(chain_.stops[k - 1].cells[slot]),
                    grid_.centre(chain_.stops[k].cells[leg.target_of[slot]]));
  }

  static bool clear(const Leg& leg) { return leg.walkable && leg.conflicts.empty(); }

  /// Where blocked cells made the walks to an exact formation fail, the people are shifted from cell to cell instead,
  /// which needs more marks and is found whenever there is time for it.
  bool mend() {
    if (ways_.open()) return true;
    Chain whole;
    whole.stops.push_back(chain_.stops.front());
    for (std::size_t k = 1; k < chain_.stops.size();) {
      if (progress_.stopped()) return false;
      std::size_t end = k;
      bool good = true;
      for (;; ++end) {
        good = good && clear(chain_.legs[end - 1]);
        if (chain_.stops[end].station) break;
      }
      const std::size_t before = whole.stops.size();
      if (good || !exact(chain_.stops[end]) || !shift_to(chain_.stops[end], whole)) {
        whole.stops.resize(before);
        whole.legs.resize(before - 1);
        whole.longest_m.resize(before - 1);
        for (std::size_t j = k; j <= end; ++j) {
          whole.stops.push_back(chain_.stops[j]);
          whole.legs.push_back(chain_.legs[j - 1]);
          whole.longest_m.push_back(chain_.longest_m[j - 1]);
        }
      }
      k = end + 1;
    }
    chain_ = std::move(whole);
    return true;
  }

  /// Appends the stops and legs to `goal`, several steps at a time where that can be walked straight.
  bool shift_to(const Stop& goal, Chain& whole) const {
    const Show& show = *task_.show;
    const Stop start = whole.stops.back();
    const double total_s = to_seconds(goal.arrive - start.depart);
    const double speed = section_speed(show, show.sections[goal.section.at()]);
    const int most = static_cast<int>(total_s * speed / (kStepMargin * grid_.pitch_m()));
    const auto places = shift({&ways_, start.cells, goal.own, most});
    if (!places) return false;
    const std::size_t steps = places->size() - 1;
    for (std::size_t step = 0; step < steps;) {
      bool found = false;
      for (std::size_t stride = kStride; stride > 0 && !found; stride /= 2) {
        const std::size_t next = std::min(steps, step + stride);
        Stop stop = goal;
        if (next < steps) {
          stop = {};
          stop.arrive = stop.depart = start.depart + seconds(total_s * double(next) / double(steps));
          stop.count = show.tempo.count_at(stop.arrive);
          stop.section = goal.section;
        }
        const double walked_s = to_seconds(stop.arrive - whole.stops.back().depart);
        const double longest_m = std::max(0.0, speed * walked_s - kRounding_m);
        Leg leg = settle({&ways_, (*places)[step], (*places)[next], longest_m, task_.clearance_m});
        if (!clear(leg)) continue;
        found = true;
        stop.cells = next < steps ? (*places)[next] : goal.own;
        if (next == steps) reorder((*places)[next], goal.own, leg.target_of);
        whole.stops.push_back(std::move(stop));
        whole.legs.push_back(std::move(leg));
        whole.longest_m.push_back(longest_m);
        step = next;
      }
      if (!found) return false;
    }
    return true;
  }

  /// Turns positions in `cells` into positions in `own`, the same cells in another order.
  void reorder(const std::vector<CellIndex>& cells, const std::vector<CellIndex>& own,
               std::vector<std::uint32_t>& target_of) const {
    std::vector<std::uint32_t> at_cell(static_cast<std::size_t>(grid_.size()), 0);
    for (std::uint32_t i = 0; i < own.size(); ++i) at_cell[own[i].at()] = i;
    for (std::uint32_t& target : target_of) target = at_cell[cells[target].at()];
  }

  /// Everybody uses the time that is left evenly.
  void aim_on_the_way(std::size_t k, std::size_t goal, std::vector<Wanted>& wanted) const {
    const Stop& before = chain_.stops[k - 1];
    const double part =
        to_seconds(chain_.stops[k].arrive - before.depart) / to_seconds(chain_.stops[goal].arrive - before.depart);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      const Point here = grid_.centre(before.cells[i]);
      const Point there = grid_.centre(chain_.stops[goal].own[i]);
      const double length_m = ways_.toward(here, there, 0).length_m;
      wanted[i] = {std::isfinite(length_m) ? ways_.toward(here, there, part * length_m).at : here, false};
    }
  }

  const ChainTask& task_;
  const Progress& progress_;
  const Ways& ways_;
  const Grid& grid_;
  const std::vector<Station>& stations_;
  CellFlags reserve_;
  std::vector<std::vector<std::uint32_t>> pairings_;
  std::vector<std::vector<CellIndex>> slots_;
  Chain chain_;
};

}  // namespace

std::optional<Chain> walk_through(const ChainTask& task, const Progress& progress) {
  return ChainBuilder(task, progress).run();
}

}  // namespace footlight::planner
