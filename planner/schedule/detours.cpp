// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/detours.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <queue>
#include <tuple>
#include <unordered_set>

#include "core/check.hpp"
#include "planner/repair/lateness.hpp"
#include "planner/repair/room.hpp"
#include "planner/schedule/slabs.hpp"

namespace footlight::planner {
namespace {

constexpr double kRounding_m = 1e-9;
/// A step reaches so many pitches: at least to the neighbours across the corners.
constexpr double kReach = 1.4143;
/// What meeting somebody costs, pitches of walking; more each time that it is the same.
constexpr double kMeeting = 2;
/// What a mark on the way costs, pitches of walking.
constexpr double kMark = 0.1;
/// So many cells and beats one search looks at.
constexpr std::size_t kMostStates = 3000;
/// Steps that are looked at for each of the conflicts at the start, and for some more.
constexpr std::size_t kLooks = 4000;
constexpr std::size_t kMostLooks = 3'000'000;

using Path = std::vector<Knot>;
using Pair = std::pair<std::uint32_t, std::uint32_t>;

class Detourer {
 public:
  Detourer(const DetourTask& task, const Leg& leg, const Progress& progress)
      : task_(task),
        grid_(task.ways->grid()),
        progress_(progress),
        room_(task.clearance_m, task.radius_m, grid_.pitch_m()),
        late_share_(std::min(1.0, task.lag_s / task.time_s)) {
    FL_CHECK(task.time_s > 0 && task.speed_mps > 0 && task.beat_s > 0);
    set_beats();
    paths_.resize(task.from.size());
    for (std::uint32_t i = 0; i < paths_.size(); ++i) {
      target_.push_back(task.to[leg.target_of[i]]);
      const Point start = grid_.centre(task.from[i]);
      const Point end = grid_.centre(target_[i]);
      const Leg::Timing when = leg.timing.empty() ? Leg::Timing{} : leg.timing[i];
      if (when.start > 0) paths_[i].push_back({0, start});
      paths_[i].push_back({when.start, start});
      paths_[i].push_back({when.end, end});
      if (when.end < 1) paths_[i].push_back({1, end});
    }
    straight_ = paths_;
    met_.resize(paths_.size(), 0);
  }

  std::optional<Leg> run(const Leg& leg) {
    if (steps() < 2) return std::nullopt;
    slabs_.emplace(grid_, at_, paths_, room_.widest_m(), late_share_, task_.speed_mps * task_.time_s);
    for (const auto& pair : leg.conflicts) open_.push_back(pair);
    for (const auto& pair : leg.late_conflicts) open_.push_back(pair);
    const std::size_t most_looks = std::min(kMostLooks, kLooks * (open_.size() + 16));
    while (!open_.empty()) {
      const auto [a, b] = open_.front();
      open_.pop_front();
      if (!conflict(a, b)) continue;
      if (progress_.stopped() || looks_ > most_looks) return std::nullopt;
      ++often_[{std::min(a, b), std::max(a, b)}];
      if (!part(a, b)) return std::nullopt;
    }
    for (const std::uint32_t person : changed_people()) simplify(person);
    return mended(leg);
  }

 private:
  /// How somebody could go, and what that costs.
  struct Way {
    Path path;
    double cost_m = 0;
    bool clear = false;
  };
  struct State {
    CellIndex cell;
    std::uint32_t beat = 0;
    std::uint32_t before = 0;  ///< position in the states
    double cost_m = 0;         ///< without meetings on the way here while those are not known
    bool known = false;        ///< the meetings on the way here are in the cost
    bool clear = true;
  };

  [[nodiscard]] std::uint32_t steps() const { return static_cast<std::uint32_t>(at_.size() - 1); }
  [[nodiscard]] double seconds_of(std::uint32_t first, std::uint32_t last) const {
    return task_.time_s * (at_[last] - at_[first]);
  }

  /// Steps are whole beats; the last one takes what is left over.
  void set_beats() {
    const double least_s = kReach * grid_.pitch_m() / task_.speed_mps;
    const double step_s = task_.beat_s * std::ceil(least_s / task_.beat_s - 1e-9);
    const int count = std::max(1, static_cast<int>(std::floor(task_.time_s / step_s + 1e-9)));
    for (int k = 0; k < count; ++k) at_.push_back(k * step_s / task_.time_s);
    at_.push_back(1);
  }

  [[nodiscard]] double least_m(std::uint32_t a, std::uint32_t b) const { return room_.between_m(a, b) - kRounding_m; }
  [[nodiscard]] bool conflict(std::uint32_t a, std::uint32_t b) const {
    const double least = least_m(a, b);
    return least_squared_along_m2(paths_[a], paths_[b], late_share_) < least * least;
  }

  /// Whether somebody comes too near another on a straight part of her way.
  [[nodiscard]] bool meets(const std::array<Knot, 2>& part, std::uint32_t person, std::uint32_t other) const {
    const double least = least_m(person, other);
    const Path& path = paths_[other];
    const auto after = std::upper_bound(path.begin() + 1, path.end() - 1, part[0].at - late_share_,
                                        [](double at, const Knot& knot) { return at < knot.at; });
    if (after->at >= std::min(1.0, part[1].at + late_share_)) {
      // Straight beside straight: lateness brings them no nearer than the way that the slower makes in it.
      const Knot& before = *(after - 1);
      const Point its = 1 / (after->at - before.at) * (after->point - before.point);
      const Point own = 1 / (part[1].at - part[0].at) * (part[1].point - part[0].point);
      const Point now = part[0].point - (before.point + (part[0].at - before.at) * its);
      const Point way = own - its;
      const double square = squared_length(way);
      const double until = part[1].at - part[0].at;
      const double at = square > 0 ? std::clamp(-dot(now, way) / square, 0.0, until) : 0;
      const double late_m = late_share_ * std::sqrt(std::min(squared_length(own), squared_length(its)));
      if (squared_length(now + at * way) >= (least + late_m) * (least + late_m)) return false;
    }
    return least_squared_along_m2(part, path, late_share_) < least * least;
  }

  /// Calls visit(other) for everybody whom somebody meets on the part of her way between two beats.
  template <class Visit>
  void visit_met(std::uint32_t person, std::uint32_t first, std::uint32_t last, Point from, Point to, Visit visit) {
    const std::array part{Knot{at_[first], from}, Knot{at_[last], to}};
    const double walk_m = distance(from, to) / (at_[last] - at_[first]);
    ++query_;
    ++looks_;
    for (std::uint32_t slab = first; slab < last; ++slab) {
      const double middle = ((at_[slab] + at_[slab + 1]) / 2 - at_[first]) / (at_[last] - at_[first]);
      slabs_->visit_near(slab, from + middle * (to - from), walk_m, [&](std::uint32_t other) {
        if (other == person || met_[other] == query_) return;
        met_[other] = query_;
        if (meets(part, person, other)) visit(other);
      });
    }
  }

  [[nodiscard]] double meetings_m(std::uint32_t person, const State& from, const State& to) {
    double sum = 0;
    visit_met(person, from.beat, to.beat, grid_.centre(from.cell), grid_.centre(to.cell), [&](std::uint32_t other) {
      const auto often = often_.find({std::min(person, other), std::max(person, other)});
      sum += kMeeting * grid_.pitch_m() * (1 + (often == often_.end() ? 0 : often->second));
    });
    return sum;
  }

  /// One of the two goes elsewhere: one who meets nobody then, else the one for whom it is cheaper.
  bool part(std::uint32_t a, std::uint32_t b) {
    const auto length_m = [&](std::uint32_t i) { return distance(paths_[i].front().point, paths_[i].back().point); };
    if (length_m(b) < length_m(a)) std::swap(a, b);
    std::optional<Way> of_a = search(a);
    if (of_a && of_a->clear) return take(a, std::move(*of_a));
    std::optional<Way> of_b = search(b);
    if (of_b && (of_b->clear || !of_a || of_b->cost_m < of_a->cost_m)) return take(b, std::move(*of_b));
    return of_a && take(a, std::move(*of_a));
  }

  bool take(std::uint32_t person, Way way) {
    set_path(person, std::move(way.path));
    if (way.clear) return true;
    const Path& path = paths_[person];
    for (const std::uint32_t other : slabs_->near(path)) {
      if (other != person && conflict(person, other)) open_.emplace_back(person, other);
    }
    return true;
  }

  void set_path(std::uint32_t person, Path path) {
    slabs_->remove(person, paths_[person]);
    paths_[person] = std::move(path);
    slabs_->add(person, paths_[person]);
  }

  /// The cheapest way from cell to cell, a step a beat, and straight to the target from wherever that is best: A* in
  /// which the meetings of a step are only looked for when it is the cheapest one left.
  std::optional<Way> search(std::uint32_t person) {
    const CellIndex target = target_[person];
    const Point goal = grid_.centre(target);
    states_.clear();
    closed_.clear();
    queue_ = {};
    states_.push_back({task_.from[person], 0, 0, 0, true, true});
    queue_.push({distance(grid_.centre(task_.from[person]), goal), 0, 0});
    while (!queue_.empty() && closed_.size() < kMostStates) {
      const std::uint32_t n = queue_.top().state;
      queue_.pop();
      const State here = states_[n];
      const std::uint64_t place = std::uint64_t{here.cell.value()} * at_.size() + here.beat;
      if (closed_.count(place) > 0) continue;
      if (!here.known) {
        const State& before = states_[here.before];
        if (!task_.ways->open() && !task_.ways->straight(grid_.centre(before.cell), grid_.centre(here.cell))) continue;
        const double more_m = meetings_m(person, before, here);
        states_[n].known = true;
        states_[n].clear = before.clear && more_m == 0;
        if (more_m > 0) {
          states_[n].cost_m += more_m;
          push(n, goal);
          continue;
        }
      }
      closed_.insert(place);
      if (here.beat == steps()) return way_to(n);
      expand(n, target, goal);
    }
    return std::nullopt;
  }

  void push(std::uint32_t n, Point goal) {
    const State& state = states_[n];
    queue_.push({state.cost_m + distance(grid_.centre(state.cell), goal), steps() - state.beat, n});
  }

  void expand(std::uint32_t n, CellIndex target, Point goal) {
    const State here = states_[n];
    const Point at = grid_.centre(here.cell);
    const auto to = [&](CellIndex cell, std::uint32_t beat) {
      const double walk_m = distance(at, grid_.centre(cell));
      const double mark_m = here.beat == 0 || cell == here.cell ? 0 : kMark * grid_.pitch_m();
      states_.push_back({cell, beat, n, here.cost_m + walk_m + mark_m, false, true});
      push(static_cast<std::uint32_t>(states_.size() - 1), goal);
    };
    const double left_m = distance(at, goal);
    if (left_m <= task_.speed_mps * seconds_of(here.beat, steps()) - kRounding_m) to(target, steps());
    const std::uint32_t next = here.beat + 1;
    if (next >= steps()) return;
    const double reach_m = task_.speed_mps * seconds_of(here.beat, next) - kRounding_m;
    const double later_m = task_.speed_mps * seconds_of(next, steps()) - kRounding_m;
    for (const CellIndex cell : grid_.within(at, reach_m)) {
      if (cell != here.cell && !task_.ways->can_stand(cell)) continue;
      if (distance(grid_.centre(cell), goal) <= later_m) to(cell, next);
    }
  }

  [[nodiscard]] Way way_to(std::uint32_t n) const {
    Way way;
    way.cost_m = states_[n].cost_m;
    way.clear = states_[n].clear;
    for (;; n = states_[n].before) {
      way.path.push_back({at_[states_[n].beat], grid_.centre(states_[n].cell)});
      if (n == 0) break;
    }
    std::reverse(way.path.begin(), way.path.end());
    return way;
  }

  [[nodiscard]] std::vector<std::uint32_t> changed_people() const {
    std::vector<std::uint32_t> people;
    for (std::uint32_t i = 0; i < paths_.size(); ++i) {
      const auto same = [](const Knot& a, const Knot& b) { return a.at == b.at && a.point == b.point; };
      if (!std::equal(paths_[i].begin(), paths_[i].end(), straight_[i].begin(), straight_[i].end(), same)) {
        people.push_back(i);
      }
    }
    return people;
  }

  /// Leaves out the marks without which nobody is met either: all of them, if that can be, else one after the other.
  void simplify(std::uint32_t person) {
    if (try_path(person, straight_[person])) return;
    for (std::size_t k = 1; k + 1 < paths_[person].size();) {
      Path shorter = paths_[person];
      shorter.erase(shorter.begin() + static_cast<std::ptrdiff_t>(k));
      if (!try_path(person, std::move(shorter))) ++k;
    }
  }

  bool try_path(std::uint32_t person, Path path) {
    for (std::size_t k = 0; k + 1 < path.size(); ++k) {
      const double walk_m = distance(path[k].point, path[k + 1].point);
      const double most_m = task_.speed_mps * task_.time_s * (path[k + 1].at - path[k].at) - kRounding_m;
      if (walk_m > 0 && walk_m > most_m) return false;
      if (!task_.ways->straight(path[k].point, path[k + 1].point)) return false;
    }
    for (const std::uint32_t other : slabs_->near(path)) {
      const double least = least_m(person, other);
      if (other == person) continue;
      if (least_squared_along_m2(path, paths_[other], late_share_) < least * least) return false;
    }
    set_path(person, std::move(path));
    return true;
  }

  [[nodiscard]] Leg mended(const Leg& before) const {
    Leg leg = before;
    leg.conflicts.clear();
    if (task_.lag_s > 0) leg.late_conflicts.clear();
    for (const std::uint32_t person : changed_people()) {
      if (leg.timing.empty()) leg.timing.resize(paths_.size());
      // Who stands at first, or at last, walks at another time and needs no mark for that.
      std::size_t first = 0;
      std::size_t last = paths_[person].size() - 1;
      const Path& path = paths_[person];
      while (first + 1 < last && path[first + 1].point == path[first].point) ++first;
      while (last > first + 1 && path[last - 1].point == path[last].point) --last;
      leg.timing[person] = {path[first].at, path[last].at};
      for (std::size_t k = first + 1; k < last; ++k) {
        leg.vias.push_back({person, path[k].at, grid_.nearest(path[k].point)});
      }
    }
    return leg;
  }

  struct Entry {
    double cost_m = 0;
    std::uint32_t left = 0;  ///< steps; of equals who is further in time
    std::uint32_t state = 0;
    friend bool operator<(const Entry& a, const Entry& b) {
      return std::tuple(-a.cost_m, -double(a.left), -double(a.state)) <
             std::tuple(-b.cost_m, -double(b.left), -double(b.state));
    }
  };

  const DetourTask& task_;
  const Grid& grid_;
  const Progress& progress_;
  Room room_;
  double late_share_;
  std::vector<double> at_;  ///< shares of the time at which the steps begin, and 1
  std::vector<CellIndex> target_;
  std::vector<Path> paths_;
  std::vector<Path> straight_;
  std::optional<Slabs> slabs_;
  std::deque<Pair> open_;
  std::map<Pair, int> often_;
  std::vector<std::uint32_t> met_;  ///< of each person: the last query in which she was looked at
  std::uint32_t query_ = 0;
  std::size_t looks_ = 0;
  std::vector<State> states_;
  std::unordered_set<std::uint64_t> closed_;
  std::priority_queue<Entry> queue_;
};

}  // namespace

std::optional<Leg> detour(const DetourTask& task, const Leg& leg, const Progress& progress) {
  FL_CHECK(leg.walkable && task.from.size() == task.to.size());
  return Detourer(task, leg, progress).run(leg);
}

}  // namespace footlight::planner
