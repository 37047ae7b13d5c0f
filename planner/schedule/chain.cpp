// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/chain.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "core/check.hpp"
#include "planner/hierarchy/hierarchical_matching.hpp"
#include "planner/motion/swept_discs.hpp"
#include "planner/parallel.hpp"
#include "planner/schedule/beats.hpp"
#include "planner/schedule/mend.hpp"
#include "planner/schedule/step.hpp"
#include "planner/schedule/stops_over_cells.hpp"

namespace footlight::planner {
namespace {

constexpr double kRounding_m = 1e-9;
/// On the way around blocked cells there is a stop whenever somebody may have walked so many pitches.
constexpr double kViaPitches = 4.5;
/// Longest steps in which people wait before or after a walk to an exact formation: a count is halved until it is no
/// longer than this. Every instant is a switch of all markers; in films the drawing gives way instead.
constexpr double kWait_s = 0.6;

class ChainBuilder {
 public:
  ChainBuilder(const ChainTask& task, const Progress& progress)
      : task_(task),
        progress_(progress),
        ways_(*task.ways),
        grid_(task.ways->grid()),
        stations_(*task.stations),
        casting_(task.casting != nullptr ? *task.casting : kFree),
        reserve_(static_cast<std::size_t>(grid_.size()), 0) {
    for (const CellIndex cell : task.show->stage.reserve) reserve_[cell.at()] = 1;
    StageHash floor("floor");
    floor.add(grid_.kind()).add(grid_.columns()).add(grid_.rows()).add(grid_.pitch_m());
    floor.list(task.show->stage.blocked).add(ways_.keep_m());
    floor_ = floor.key();
  }

  std::optional<Chain> run() {
    if (!pair_all()) return std::nullopt;
    follow_slots();
    for (std::size_t s = 0; s < stations_.size(); ++s) add_stop(s);
    if (has_moving_obstacles(*task_.show)) keep_off_discs();
    if (!pace()) return std::nullopt;
    if (over_cells()) {
      chain_ = stops_over_cells(std::move(chain_), after_, beats_, *task_.show);
    } else if (!mend(mending(), chain_, progress_)) {
      return std::nullopt;
    }
    name_people();
    return std::move(chain_);
  }

 private:
  bool pair_all() {
    pairings_.resize(stations_.size() - 1);
    const std::vector<std::size_t> changing = changing_intervals(stations_, casting_);
    const bool done = for_each_index(pairings_.size(), "pairing", progress_, [&](std::size_t k) {
      const bool changes = std::binary_search(changing.begin(), changing.end(), k);
      if (!changes) pairings_[k] = recalled_pair(stations_[k], stations_[k + 1]);
    });
    if (!done || casting_.free()) return done;
    const auto pair_one = [&](const Station& from, const Station& to) {
      return progress_.stopped() ? numbers(from.cells.size()) : recalled_pair(from, to);
    };
    CastTracks tracks = cast_tracks(grid_, stations_, casting_, pair_one, std::move(pairings_));
    pairings_ = std::move(tracks.pairing);
    who_ = std::move(tracks.who);
    kinds_ = exchange_kinds(casting_, stations_.front().cells.size(), stations_.size());
    return !progress_.stopped();
  }

  [[nodiscard]] std::vector<std::uint32_t> recalled_pair(const Station& from, const Station& to) const {
    const PlannerOptions& options = task_.show->sections[to.section.at()].planner;
    if (task_.counts == nullptr && task_.stages == nullptr) return pair(from, to);
    StageHash hash("pairing");
    hash.add(floor_).list(task_.show->stage.reserve).list(from.cells).list(to.cells);
    hash.add(to.follows).add(options.model).add(options.layers).add(options.region_size);
    hash.add(options.region_variance_m2).add(options.cost);
    return recall(
        task_.stages, hash.key(), task_.counts == nullptr ? nullptr : &task_.counts->pairings,
        [](StageReader& reader) { return reader.list<std::uint32_t>(); },
        [](const std::vector<std::uint32_t>& target_of) { return StageWriter().list(target_of).take(); },
        [&] { return pair(from, to); });
  }

  /// Who waits in the reserve before and after stays where she is; the others as the section asks for.
  [[nodiscard]] std::vector<std::uint32_t> pair(const Station& from, const Station& to) const {
    std::vector<std::uint32_t> target_of(from.cells.size());
    if (to.follows) return numbers(target_of.size());
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

  /// Slots are numbered anew at each exact formation.
  void follow_slots() {
    std::vector<std::uint32_t> at = numbers(stations_.front().cells.size());
    slots_.assign(stations_.size(), std::vector<CellIndex>(at.size()));
    place_of_.resize(stations_.size());
    for (std::size_t s = 0; s < stations_.size(); ++s) {
      for (std::uint32_t slot = 0; slot < at.size(); ++slot) {
        if (s > 0) at[slot] = pairings_[s - 1][at[slot]];
        slots_[s][slot] = stations_[s].cells[at[slot]];
      }
      place_of_[s] = at;
      if (s > 0 && !stations_[s].exact) continue;
      at = numbers(at.size());
    }
  }

  void add_stop(std::size_t s) {
    const Station& station = stations_[s];
    if (s > 0 && !over_cells()) add_vias(s);
    if (s > 0) link(station.section, station.arrive);
    Stop stop;
    stop.count = station.count;
    stop.arrive = station.arrive;
    stop.depart = station.depart;
    stop.station = s;
    stop.section = station.section;
    stop.own = slots_[s];
    stop.exact = station.exact || s == 0;
    if (stop.exact) stop.cells = station.cells;
    chain_.stops.push_back(std::move(stop));
  }

  void link(SectionIndex section, Instant arrive) {
    const Show& show = *task_.show;
    const double speed = section_speed(show, show.sections[section.at()]);
    const Instant depart = chain_.stops.back().depart;
    if (over_cells()) {
      beats_.push_back(beats_between(show.tempo, depart, arrive, grid_.pitch_m() / speed));
      chain_.longest_m.push_back(beats_.back().steps() * grid_.pitch_m());
      return;
    }
    chain_.longest_m.push_back(std::max(0.0, speed * to_seconds(arrive - depart) - kRounding_m));
  }

  /// The floor of each walk while something moves over it.
  void keep_off_discs() {
    const std::vector<Stop>& stops = chain_.stops;
    leg_ways_.resize(stops.size());
    leg_floor_.assign(stops.size(), floor_);
    for (std::size_t k = 1; k < stops.size(); ++k) {
      const Instant next = k + 1 < stops.size() ? stops[k + 1].arrive : stops[k].depart;
      const std::vector<SweptDisc> during = swept_discs(*task_.show, stops[k - 1].depart, stops[k].arrive);
      const std::vector<SweptDisc> after = swept_discs(*task_.show, stops[k].arrive, next);
      if (during.empty() && after.empty()) continue;
      leg_floor_[k] = floor_with_discs(floor_, during, after);
      leg_ways_[k] = std::make_unique<const Ways>(ways_.beside(during, after));
    }
  }
  /// Of the walk to a stop.
  [[nodiscard]] const Ways& ways_toward(std::size_t k) const {
    return k < leg_ways_.size() && leg_ways_[k] ? *leg_ways_[k] : ways_;
  }
  [[nodiscard]] const StageKey& floor_toward(std::size_t k) const {
    return k < leg_floor_.size() ? leg_floor_[k] : floor_;
  }

  [[nodiscard]] bool over_cells() const { return task_.show->stage.walk == WalkKind::cells; }

  /// Between two exact formations, where blocked cells are in somebody's way.
  void add_vias(std::size_t s) {
    if (ways_.open() || !stations_[s].exact) return;
    bool straight = true;
    for (std::size_t i = 0; i < slots_[s].size() && straight; ++i) {
      const CellIndex from = chain_.stops.back().exact ? chain_.stops.back().cells[i] : slots_[s - 1][i];
      straight = ways_.straight(grid_.centre(from), grid_.centre(slots_[s][i]));
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

  [[nodiscard]] bool ends_section(const Stop& stop) const {
    return stop.station && (*stop.station + 1 == stations_.size() ||
                            stations_[*stop.station + 1].section != stations_[*stop.station].section);
  }

  /// Stretches between exact formations do not depend on each other.
  bool pace() {
    chain_.legs.resize(chain_.stops.size() - 1);
    after_.resize(chain_.legs.size());
    std::vector<std::size_t> ends{0};
    for (std::size_t k = 1; k < chain_.stops.size(); ++k) {
      if (chain_.stops[k].exact || k + 1 == chain_.stops.size()) ends.push_back(k);
    }
    return for_each_index(ends.size() - 1, "walks", progress_,
                          [&](std::size_t n) { walk_stretch(ends[n], ends[n + 1]); });
  }

  /// The ideal tracks from `first` to `last`, numbered as in between.
  [[nodiscard]] std::vector<PaceInstant> instants_of(std::size_t first, std::size_t last) const {
    std::vector<PaceInstant> instants(last - first + 1);
    const std::vector<CellIndex>* heading = &chain_.stops[last].own;
    for (std::size_t k = last + 1; k-- > first;) {
      const Stop& stop = chain_.stops[k];
      // On the way everybody heads for the formation at its end.
      if (stop.station) heading = k == first ? &stop.cells : &stop.own;
      instants[k - first] = {*heading, stop.exact || ends_section(stop) || !stop.station,
                             k < chain_.longest_m.size() ? chain_.longest_m[k] : 0.0};
    }
    return instants;
  }

  /// Who waits, waits on the beat: a whole count where it is no longer than that.
  [[nodiscard]] double wait_s(Instant at) const {
    const TempoMap& tempo = task_.show->tempo;
    double wait = 60 / tempo.bpm_at(tempo.count_at(at));
    while (wait > kWait_s) wait /= 2;
    return wait;
  }

  /// Place in a station's list of a slot, as numbered from there on.
  [[nodiscard]] std::uint32_t place_at(std::size_t s, std::uint32_t slot) const {
    return s == 0 || stations_[s].exact ? slot : place_of_[s][slot];
  }
  /// Of each slot on the way to a stop what a list says of the performer who has it as drawn.
  template <class Value>
  [[nodiscard]] std::vector<Value> toward(std::size_t k, const std::vector<Value>& of_performer) const {
    if (of_performer.empty()) return {};
    const std::size_t before = *chain_.stops[heading_of(k)].station - 1;
    std::vector<Value> out(chain_.stops[k].own.size());
    for (std::uint32_t slot = 0; slot < out.size(); ++slot)
      out[slot] = of_performer[who_[before][place_at(before, slot)]];
    return out;
  }
  [[nodiscard]] std::vector<std::uint32_t> kind_toward(std::size_t k) const {
    return kinds_.empty() ? std::vector<std::uint32_t>() : toward(k, kinds_[*chain_.stops[heading_of(k)].station - 1]);
  }
  [[nodiscard]] std::vector<double> radius_toward(std::size_t k) const { return toward(k, casting_.radius_m); }
  [[nodiscard]] MendTask mending() const {
    return {&task_, [this](std::size_t k) { return kind_toward(k); },
            [this](std::size_t k) { return radius_toward(k); }, [this](Instant at) { return wait_s(at); },
            [this](std::size_t k) { return &ways_toward(k); }};
  }
  static std::vector<std::uint32_t> numbers(std::size_t size) {
    std::vector<std::uint32_t> out(size);
    std::iota(out.begin(), out.end(), 0U);
    return out;
  }

  void walk_stretch(std::size_t first, std::size_t last) {
    const std::vector<PaceInstant> instants = instants_of(first, last);
    auto wanted = leave_early(ways_, instants, reserve_);
    // How far from their places in an exact formation at the end people may be at each stop.
    std::vector<double> reach_m(instants.size(), 0.0);
    for (std::size_t n = instants.size() - 1; n-- > 0;) {
      const double longest_m = instants[n].longest_m;
      reach_m[n] = n + 2 == instants.size() ? longest_m : reach_m[n + 1] + paced_m(longest_m, grid_.pitch_m());
    }
    if (over_cells()) {
      for (double& reach : reach_m) reach *= straight_per_step(grid_.kind());
    }
    for (std::size_t k = first + 1; k <= last && !progress_.stopped(); ++k) {
      Stop& stop = chain_.stops[k];
      const std::size_t n = k - first;
      if (!stop.station) aim_on_the_way(k, heading_of(k), wanted[n]);
      StepTask task;
      task.snap.ways = &ways_toward(k);
      task.snap.now = chain_.stops[k - 1].cells;
      task.snap.own = instants[n].own;
      task.snap.wanted = wanted[n];
      task.snap.longest_m = chain_.longest_m[k - 1];
      task.snap.onward_m = instants[n].longest_m;
      if (k < last) {
        task.snap.onward = wanted[n + 1];
        task.next_own = instants[n + 1].own;
      }
      const std::vector<CellIndex> goals =
          chain_.stops[last].exact && k < last ? binding_goals(k, last, reach_m[n]) : std::vector<CellIndex>();
      task.snap.goal = goals;
      task.snap.goal_m = reach_m[n];
      task.exact = stop.exact;
      task.clearance_m = task_.clearance_m;
      task.walked_s = to_seconds(stop.arrive - chain_.stops[k - 1].depart);
      task.lag_s = to_seconds(task_.show->stage.lag);
      task.wait_s = stop.exact ? wait_s(stop.arrive) : 0;
      if (over_cells()) task.over_cells = {beats_[k - 1].steps(), beats_[k - 1].step_s};
      const auto kind = kind_toward(k);
      const auto radius_m = radius_toward(k);
      task.kind = kind;
      task.radius_m = radius_m;
      task.stop = progress_.stop;
      Step step =
          walk_step(task, floor_toward(k), task_.stages, task_.counts == nullptr ? nullptr : &task_.counts->walks);
      if (stop.exact) {
        for (std::uint32_t& target : step.leg.target_of) target = place_of_[*stop.station][target];
      } else {
        stop.cells = std::move(step.cells);
        for (std::size_t i = 0; i < stop.own.size(); ++i) {
          stop.given_way += stop.cells[i] != stop.own[i] && reserve_[stop.own[i].at()] == 0 ? 1 : 0;
        }
      }
      chain_.legs[k - 1] = std::move(step.leg);
      after_[k - 1] = std::move(step.after);
    }
  }

  [[nodiscard]] std::size_t heading_of(std::size_t k) const {
    while (!chain_.stops[k].station) ++k;
    return k;
  }

  /// Where the slots must be in the exact formation `last`, for those who could walk too far away from it now; empty
  /// when nobody could.
  [[nodiscard]] std::vector<CellIndex> binding_goals(std::size_t k, std::size_t last, double reach_m) const {
    const std::vector<CellIndex>& now = chain_.stops[k - 1].cells;
    std::vector<CellIndex> goals = chain_.stops[last].own;
    bool any = false;
    for (std::size_t i = 0; i < goals.size(); ++i) {
      const double away_m = distance(grid_.centre(now[i]), grid_.centre(goals[i]));
      if (away_m + chain_.longest_m[k - 1] <= reach_m) {
        goals[i] = kNoGoal;
      } else {
        any = true;
      }
    }
    if (!any) goals.clear();
    return goals;
  }

  void name_people() {
    std::vector<std::uint32_t> slot = numbers(stations_.front().cells.size());
    std::vector<TrackPlaces> visited;
    for (std::size_t k = 0; k < chain_.stops.size() && !casting_.bindings.empty(); ++k) {
      for (std::size_t i = 0; i < slot.size() && k > 0; ++i) slot[i] = chain_.legs[k - 1].target_of[slot[i]];
      const auto station = chain_.stops[k].station;
      if (!station || !casting_.bindings[*station].binds()) continue;
      TrackPlaces& here = visited.emplace_back(TrackPlaces{*station, slot});
      for (std::uint32_t& place : here.place) place = place_at(*station, place);
    }
    NamedTracks named = name_tracks(casting_, who_, visited, slot.size());
    chain_.first_place = std::move(named.first_place);
    chain_.alike = std::move(named.alike);
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
  static inline const Casting kFree{};
  const Casting& casting_;
  CellFlags reserve_;
  std::vector<std::vector<std::uint32_t>> pairings_;
  std::vector<std::vector<CellIndex>> slots_;
  std::vector<std::vector<std::uint32_t>> place_of_;  // of each station: place in its list of each slot before it
  std::vector<std::vector<std::uint32_t>> who_;       // performer on each place of each station as drawn; may be empty
  std::vector<std::vector<std::uint32_t>> kinds_;     // of each performer in each interval between stations
  StageKey floor_{};
  std::vector<std::unique_ptr<const Ways>> leg_ways_;  // of the walk to each stop; nothing: ways_; empty: of none
  std::vector<StageKey> leg_floor_;                    // as leg_ways_
  std::vector<Beats> beats_;                           // over cells: of each leg
  std::vector<StepsOfLeg> after_;                      // over cells: of each leg, as Step::after
  Chain chain_;
};

}  // namespace

Chain::WalkTimes Chain::walk_times(std::size_t leg, std::uint32_t slot) const {
  const Instant start = stops[leg].depart;
  const Instant end = stops[leg + 1].arrive;
  const auto& timing = legs[leg].timing;
  if (timing.empty()) return {start, end};
  const Leg::Timing& own = timing[slot];
  const double whole_s = to_seconds(end - start);
  return {own.start > 0 ? start + seconds(own.start * whole_s) : start,
          own.end < 1 ? start + seconds(own.end * whole_s) : end};
}

std::vector<Mark> Chain::marks_on_the_way(std::size_t leg, std::uint32_t slot) const {
  const std::vector<Leg::Via>& vias = legs[leg].vias;
  const Instant start = stops[leg].depart;
  const double whole_s = to_seconds(stops[leg + 1].arrive - start);
  std::vector<Mark> marks;
  auto via = std::lower_bound(vias.begin(), vias.end(), slot,
                              [](const Leg::Via& one, std::uint32_t s) { return one.person < s; });
  for (; via != vias.end() && via->person == slot; ++via)
    marks.push_back({start + seconds(via->at * whole_s), via->cell});
  return marks;
}

std::optional<Chain> walk_through(const ChainTask& task, const Progress& progress) {
  return ChainBuilder(task, progress).run();
}

}  // namespace footlight::planner
