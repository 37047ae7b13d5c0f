// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/mend.hpp"

#include <algorithm>
#include <array>
#include <iterator>

#include "planner/schedule/detours.hpp"
#include "planner/schedule/passing.hpp"
#include "planner/schedule/shift.hpp"

namespace footlight::planner {
namespace {

constexpr double kRounding_m = 1e-9;
/// Room in each step for the rounding of instants.
constexpr double kStepMargin = 1.001;
/// Steps from cell to cell that are walked at once.
constexpr std::size_t kStride = 4;
/// More people do not pass each other all at once; a few of them go around others all the same.
constexpr std::size_t kMostPassing = 20'000;
/// So many times the time that there is are tried to say which would do.
constexpr std::array kLonger{1.25, 1.5, 2.0, 3.0, 5.0, 8.0};

class Mender {
 public:
  Mender(const MendTask& task, Chain& chain, const Progress& progress)
      : task_(task), show_(*task.chain->show), ways_(task.chain->ways), chain_(chain), progress_(progress) {}

  bool run() {
    whole_.first_place = chain_.first_place;
    whole_.stops.push_back(chain_.stops.front());
    for (std::size_t k = 1; k < chain_.stops.size();) {
      if (progress_.stopped()) return false;
      std::size_t end = k;
      while (!chain_.stops[end].station) ++end;
      ways_ = task_.ways_toward(end);
      if (!chain_.stops[end].exact || !replaced(k, end)) keep(k, end);
      k = end + 1;
    }
    chain_ = std::move(whole_);
    return !progress_.stopped();
  }

 private:
  static bool clear(const Leg& leg) { return leg.walkable && leg.conflicts.empty(); }
  /// Of the legs from stop k - 1 to stop `end`.
  [[nodiscard]] bool clear(std::size_t k, std::size_t end) const {
    return std::all_of(chain_.legs.begin() + std::ptrdiff_t(k) - 1, chain_.legs.begin() + std::ptrdiff_t(end),
                       [](const Leg& leg) { return clear(leg); });
  }

  void keep(std::size_t k, std::size_t end) {
    for (std::size_t j = k; j <= end; ++j) {
      whole_.stops.push_back(std::move(chain_.stops[j]));
      whole_.legs.push_back(std::move(chain_.legs[j - 1]));
      whole_.longest_m.push_back(chain_.longest_m[j - 1]);
    }
  }
  void forget_after(std::size_t stops) {
    whole_.stops.erase(whole_.stops.begin() + static_cast<std::ptrdiff_t>(stops), whole_.stops.end());
    whole_.legs.resize(stops - 1);
    whole_.longest_m.resize(stops - 1);
  }

  /// Other stops and legs for those on the way from stop k - 1 to `end`.
  /// @return false when they stay, perhaps with marks of single people
  bool replaced(std::size_t k, std::size_t end) {
    const double lag_s = to_seconds(show_.stage.lag);
    if (around(k, end, lag_s) || clear(k, end)) return false;
    const std::size_t before = whole_.stops.size();
    const std::vector<std::uint32_t> kind = task_.kind_toward(end);
    if (!ways_->open() && kind.empty()) {
      if (shift_to(chain_.stops[end])) return true;
      forget_after(before);
    }
    const Stop& goal = chain_.stops[end];
    const double total_s = to_seconds(goal.arrive - whole_.stops.back().depart);
    const auto found = passing(end, kind, total_s);
    const bool in_time = found && found->needed_s <= total_s;
    if (!(in_time && (found->tolerates_lag || lag_s <= 0)) && lag_s > 0 && around(k, end, 0)) return false;
    if (in_time) {
      append_passing(*found, goal, whole_.stops.back(), total_s);
    } else if (!progress_.stopped() && !too_far(goal, total_s)) {
      whole_.unpassed.push_back(unpassed(k, end, found, total_s));
    }
    return in_time;
  }

  /// Where a stop's people come from.
  [[nodiscard]] const Stop& before(std::size_t k, std::size_t stop) const {
    return stop == k ? whole_.stops.back() : chain_.stops[stop - 1];
  }

  /// Sends those who conflict on the way from stop k - 1 to `end` around others.
  /// @param lag_s how late people may be  @return false when that did not help everywhere; then nothing changes
  bool around(std::size_t k, std::size_t end, double lag_s) {
    std::vector<std::pair<std::size_t, Leg>> better;
    for (std::size_t stop = k; stop <= end; ++stop) {
      const Leg& leg = chain_.legs[stop - 1];
      if (clear(leg) && (lag_s <= 0 || leg.late_conflicts.empty())) continue;
      const Stop& from = before(k, stop);
      const Stop& to = chain_.stops[stop];
      auto found = detoured(leg, from.cells, to.cells, task_.radius_toward(stop),
                            {chain_.longest_m[stop - 1], to_seconds(to.arrive - from.depart), lag_s, to.arrive});
      if (!found) return false;
      better.emplace_back(stop, std::move(*found));
    }
    for (auto& [stop, leg] : better) chain_.legs[stop - 1] = std::move(leg);
    return true;
  }

  struct DetourLimits {
    double longest_m = 0;
    double time_s = 0;
    double lag_s = 0;
    Instant arrive;
  };
  [[nodiscard]] std::optional<Leg> detoured(const Leg& leg, const std::vector<CellIndex>& from,
                                            const std::vector<CellIndex>& to, const std::vector<double>& radius_m,
                                            const DetourLimits& limits) const {
    if (!leg.walkable || limits.time_s <= 0) return std::nullopt;
    DetourTask task{ways_, from, to, task_.chain->clearance_m, limits.longest_m / limits.time_s, limits.time_s};
    task.lag_s = limits.lag_s;
    task.beat_s = task_.beat_s(limits.arrive);
    task.radius_m = radius_m;
    return detour(task, leg, progress_);
  }

  [[nodiscard]] double speed(const Stop& goal) const { return section_speed(show_, show_.sections[goal.section.at()]); }

  void append(Stop stop, Leg leg) {
    const double walked_s = to_seconds(stop.arrive - whole_.stops.back().depart);
    whole_.longest_m.push_back(std::max(0.0, speed(stop) * walked_s - kRounding_m));
    whole_.stops.push_back(std::move(stop));
    whole_.legs.push_back(std::move(leg));
  }

  [[nodiscard]] Stop on_the_way(const Stop& goal, Instant at, std::vector<CellIndex> cells) const {
    Stop stop;
    stop.arrive = stop.depart = at;
    stop.count = show_.tempo.count_at(at);
    stop.section = goal.section;
    stop.cells = std::move(cells);
    return stop;
  }

  /// Appends the stops and legs to `goal`, several steps at a time where that can be walked straight: where people may
  /// be late on them, if there are such.
  bool shift_to(const Stop& goal) {
    const Stop start = whole_.stops.back();
    const double total_s = to_seconds(goal.arrive - start.depart);
    const int most = static_cast<int>(total_s * speed(goal) / (kStepMargin * ways_->grid().pitch_m()));
    const auto places = shift({ways_, start.cells, goal.cells, most});
    if (!places) return false;
    const std::size_t steps = places->size() - 1;
    for (std::size_t step = 0; step < steps;) {
      std::optional<std::size_t> found;
      Leg best;
      for (std::size_t stride = kStride; stride > 0; stride /= 2) {
        const std::size_t next = std::min(steps, step + stride);
        Leg leg = walk((*places)[step], (*places)[next], total_s * double(next - step) / double(steps), speed(goal));
        if (!clear(leg) || (found && !leg.late_conflicts.empty())) continue;
        found = next;
        best = std::move(leg);
        if (best.late_conflicts.empty()) break;
      }
      if (!found) return false;
      const bool last = *found == steps;
      if (last) reorder((*places)[steps], goal.cells, best.target_of);
      const Instant at = start.depart + seconds(total_s * double(*found) / double(steps));
      append(last ? goal : on_the_way(goal, at, (*places)[*found]), std::move(best));
      step = *found;
    }
    return true;
  }

  [[nodiscard]] Leg walk(const std::vector<CellIndex>& from, const std::vector<CellIndex>& to, double walked_s,
                         double speed_mps) const {
    LegTask leg{ways_, from, to, std::max(0.0, speed_mps * walked_s - kRounding_m), task_.chain->clearance_m};
    leg.late_share = std::min(1.0, to_seconds(show_.stage.lag) / walked_s);
    leg.stop = progress_.stop;
    return settle(leg);
  }

  /// Turns positions in `cells` into positions in `own`, the same cells in another order.
  void reorder(const std::vector<CellIndex>& cells, const std::vector<CellIndex>& own,
               std::vector<std::uint32_t>& target_of) const {
    std::vector<std::uint32_t> at_cell(static_cast<std::size_t>(ways_->grid().size()), 0);
    for (std::uint32_t i = 0; i < own.size(); ++i) at_cell[own[i].at()] = i;
    for (std::uint32_t& target : target_of) target = at_cell[cells[target].at()];
  }

  /// Somebody's own place is too far away to walk there at all.
  [[nodiscard]] bool too_far(const Stop& goal, double total_s) const {
    const std::vector<CellIndex>& from = whole_.stops.back().cells;
    for (std::size_t i = 0; i < from.size(); ++i) {
      const double walk_m = distance(ways_->grid().centre(from[i]), ways_->grid().centre(goal.own[i]));
      if (walk_m > speed(goal) * total_s) return true;
    }
    return false;
  }

  /// To the slots' own cells in the formation, numbered as before it.
  [[nodiscard]] std::optional<Passing> passing(std::size_t end, const std::vector<std::uint32_t>& kind,
                                               double total_s) const {
    const Stop& goal = chain_.stops[end];
    const std::vector<CellIndex>& from = whole_.stops.back().cells;
    if (from.size() > kMostPassing || too_far(goal, total_s)) return std::nullopt;
    PassTask task{ways_, from, goal.own, kind};
    task.clearance_m = task_.chain->clearance_m;
    task.speed_mps = speed(goal) / kStepMargin;
    task.time_s = total_s;
    task.lag_s = to_seconds(show_.stage.lag);
    const std::vector<double> radius_m = task_.radius_toward(end);
    task.radius_m = radius_m;
    return pass(task, progress_);
  }

  /// What could not be made, with a time that would do where one was found.
  [[nodiscard]] Chain::Unpassed unpassed(std::size_t k, std::size_t end, const std::optional<Passing>& found,
                                         double total_s) const {
    Chain::Unpassed out{whole_.legs.size(), total_s, {}, {}};
    if (found) {
      out.needed_s = found->needed_s;
      out.last = found->last;
    } else if (k == end) {
      for (const double times : kLonger) {
        if (progress_.stopped() || !walked_in(end, times * total_s)) continue;
        out.needed_s = times * total_s;
        break;
      }
    }
    return out;
  }

  /// Whether people come to a formation in some other time, if need be around others.
  [[nodiscard]] bool walked_in(std::size_t end, double time_s) const {
    const Stop& goal = chain_.stops[end];
    const std::vector<CellIndex>& from = whole_.stops.back().cells;
    const std::vector<std::uint32_t> kind = task_.kind_toward(end);
    const std::vector<double> radius_m = task_.radius_toward(end);
    const double longest_m = std::max(0.0, speed(goal) * time_s - kRounding_m);
    LegTask task{ways_, from, goal.own, longest_m, task_.chain->clearance_m, kind};
    task.stagger_share = task_.beat_s(goal.arrive) / time_s;
    task.radius_m = radius_m;
    task.stop = progress_.stop;
    const Leg leg = settle(task);
    return clear(leg) || detoured(leg, from, goal.own, radius_m, {longest_m, time_s, 0, goal.arrive});
  }

  /// Every step takes as long as every other where the limit allows it, else as its longest walk asks for.
  void append_passing(const Passing& found, const Stop& goal, Stop start, double total_s) {
    const std::size_t steps = found.longest_m.size();
    const double longest_m = *std::max_element(found.longest_m.begin(), found.longest_m.end());
    const bool even = longest_m * kStepMargin <= speed(goal) * total_s / static_cast<double>(steps);
    Chain::Passed& passed = whole_.passed.emplace_back();
    passed.first_stop = whole_.stops.size() - 1;
    passed.last_stop = passed.first_stop + steps;
    const Grid& grid = ways_->grid();
    const auto walk_m = [&](const std::vector<CellIndex>& from, const std::vector<CellIndex>& to) {
      double sum = 0;
      for (std::size_t i = 0; i < from.size(); ++i) sum += distance(grid.centre(from[i]), grid.centre(to[i]));
      return sum;
    };
    passed.straight_m = walk_m(found.at.front(), found.at.back());
    double done = 0;
    for (std::size_t n = 1; n <= steps; ++n) {
      done +=
          even ? 1.0 / static_cast<double>(steps) : found.longest_m[n - 1] / speed(goal) * kStepMargin / found.needed_s;
      passed.walked_m += walk_m(found.at[n - 1], found.at[n]);
      Leg leg;
      leg.target_of.resize(start.cells.size());
      for (std::uint32_t i = 0; i < leg.target_of.size(); ++i) leg.target_of[i] = i;
      if (n < steps) {
        append(on_the_way(goal, start.depart + seconds(total_s * done), found.at[n]), std::move(leg));
      } else {
        reorder(found.at[n], goal.cells, leg.target_of);
        append(goal, std::move(leg));
      }
    }
  }

  const MendTask& task_;
  const Show& show_;
  const Ways* ways_;  ///< of the walk that is looked at
  Chain& chain_;
  const Progress& progress_;
  Chain whole_;
};

}  // namespace

bool mend(const MendTask& task, Chain& chain, const Progress& progress) {
  const bool clear = std::all_of(chain.legs.begin(), chain.legs.end(), [](const Leg& leg) {
    return leg.walkable && leg.conflicts.empty() && leg.late_conflicts.empty();
  });
  return clear || Mender(task, chain, progress).run();
}

}  // namespace footlight::planner
