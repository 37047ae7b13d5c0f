// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/mend.hpp"

#include <algorithm>
#include <iterator>

#include "planner/schedule/passing.hpp"
#include "planner/schedule/shift.hpp"

namespace footlight::planner {
namespace {

constexpr double kRounding_m = 1e-9;
/// Room in each step for the rounding of instants.
constexpr double kStepMargin = 1.001;
/// Steps from cell to cell that are walked at once.
constexpr std::size_t kStride = 4;
/// More people are not looked for a way to pass each other.
constexpr std::size_t kMostPassing = 20'000;

class Mender {
 public:
  Mender(const MendTask& task, Chain& chain, const Progress& progress)
      : task_(task), show_(*task.chain->show), ways_(*task.chain->ways), chain_(chain), progress_(progress) {}

  bool run() {
    whole_.first_place = chain_.first_place;
    whole_.stops.push_back(chain_.stops.front());
    for (std::size_t k = 1; k < chain_.stops.size();) {
      if (progress_.stopped()) return false;
      std::size_t end = k;
      bool good = clear(chain_.legs[k - 1]);
      while (!chain_.stops[end].station) good = clear(chain_.legs[end++]) && good;
      if (good || !chain_.stops[end].exact || !replaced(end)) keep(k, end);
      k = end + 1;
    }
    chain_ = std::move(whole_);
    return !progress_.stopped();
  }

 private:
  static bool clear(const Leg& leg) { return leg.walkable && leg.conflicts.empty(); }

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

  /// Other stops and legs for those on the way to `end`.
  bool replaced(std::size_t end) {
    const std::size_t before = whole_.stops.size();
    const std::vector<std::uint32_t> kind = task_.kind_toward(end);
    if (!ways_.open() && kind.empty()) {
      if (shift_to(chain_.stops[end])) return true;
      forget_after(before);
    }
    return pass_to(end, kind);
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
    const int most = static_cast<int>(total_s * speed(goal) / (kStepMargin * ways_.grid().pitch_m()));
    const auto places = shift({&ways_, start.cells, goal.cells, most});
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
    LegTask leg{&ways_, from, to, std::max(0.0, speed_mps * walked_s - kRounding_m), task_.chain->clearance_m};
    leg.late_share = std::min(1.0, to_seconds(show_.stage.lag) / walked_s);
    leg.stop = progress_.stop;
    return settle(leg);
  }

  /// Turns positions in `cells` into positions in `own`, the same cells in another order.
  void reorder(const std::vector<CellIndex>& cells, const std::vector<CellIndex>& own,
               std::vector<std::uint32_t>& target_of) const {
    std::vector<std::uint32_t> at_cell(static_cast<std::size_t>(ways_.grid().size()), 0);
    for (std::uint32_t i = 0; i < own.size(); ++i) at_cell[own[i].at()] = i;
    for (std::uint32_t& target : target_of) target = at_cell[cells[target].at()];
  }

  /// The slots' own cells in the formation, numbered as before it.
  bool pass_to(std::size_t end, const std::vector<std::uint32_t>& kind) {
    const Stop& goal = chain_.stops[end];
    const Stop start = whole_.stops.back();
    const double total_s = to_seconds(goal.arrive - start.depart);
    const Grid& grid = ways_.grid();
    if (start.cells.size() > kMostPassing) return false;
    for (std::size_t i = 0; i < start.cells.size(); ++i) {
      if (distance(grid.centre(start.cells[i]), grid.centre(goal.own[i])) > speed(goal) * total_s) return false;
    }
    PassTask task{&ways_, start.cells, goal.own, kind};
    task.clearance_m = task_.chain->clearance_m;
    task.speed_mps = speed(goal) / kStepMargin;
    task.time_s = total_s;
    task.lag_s = to_seconds(show_.stage.lag);
    const std::vector<double> radius_m = task_.radius_toward(end);
    task.radius_m = radius_m;
    const auto found = pass(task, progress_);
    if (!found || found->needed_s > total_s) {
      whole_.unpassed.push_back({whole_.legs.size(), total_s, {}, 0});
      if (found) whole_.unpassed.back().needed_s = found->needed_s;
      if (found) whole_.unpassed.back().last = found->last;
      return false;
    }
    append_passing(*found, goal, start, total_s);
    return true;
  }

  /// Every step takes as long as every other where the limit allows it, else as its longest walk asks for.
  void append_passing(const Passing& found, const Stop& goal, const Stop& start, double total_s) {
    const std::size_t steps = found.longest_m.size();
    const double longest_m = *std::max_element(found.longest_m.begin(), found.longest_m.end());
    const bool even = longest_m * kStepMargin <= speed(goal) * total_s / static_cast<double>(steps);
    Chain::Passed& passed = whole_.passed.emplace_back();
    passed.first_stop = whole_.stops.size() - 1;
    passed.last_stop = passed.first_stop + steps;
    const Grid& grid = ways_.grid();
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
  const Ways& ways_;
  Chain& chain_;
  const Progress& progress_;
  Chain whole_;
};

}  // namespace

bool mend(const MendTask& task, Chain& chain, const Progress& progress) {
  const bool clear = std::all_of(chain.legs.begin(), chain.legs.end(),
                                 [](const Leg& leg) { return leg.walkable && leg.conflicts.empty(); });
  return clear || Mender(task, chain, progress).run();
}

}  // namespace footlight::planner
