// SPDX-License-Identifier: Apache-2.0
#include "planner/way_in/search.hpp"

#include <algorithm>
#include <limits>

namespace footlight::planner {
namespace {

/// No faster than anybody may walk anywhere between two instants: the person's own limit, else that of each section in
/// which a walk may end, else the stage's.
double speed_limit_mps(const Plan& plan, PerformerIndex who, Instant start, Instant end) {
  if (plan.max_speed_mps[who.at()] > 0) return plan.max_speed_mps[who.at()];
  double least = std::numeric_limits<double>::infinity();
  Instant begins = Instant::min();
  for (const PlanSection& section : plan.sections) {
    if (begins < end && section.end >= start) {
      least = std::min(least, section.max_speed_mps > 0 ? section.max_speed_mps : plan.stage.max_speed_mps);
    }
    begins = section.end;
  }
  return begins < end ? std::min(least, plan.stage.max_speed_mps) : least;
}

/// The cell on which somebody is at an instant; nothing when she is between two.
std::optional<CellIndex> cell_at(const std::vector<Mark>& track, Instant time) {
  const auto after =
      std::upper_bound(track.begin(), track.end(), time, [](Instant at, const Mark& mark) { return at < mark.time; });
  if (after == track.begin()) return after->cell;
  const Mark& before = *(after - 1);
  if (before.time == time || after == track.end() || after->cell == before.cell) return before.cell;
  return std::nullopt;
}

}  // namespace

WayInSearch::WayInSearch(const Plan& plan, const Ways& ways, const CellSteps& steps, double reach_m,
                         const WaysIn::Stretch& stretch, const WayInTask& task)
    : plan_(plan),
      grid_(plan.stage.grid),
      ways_(ways),
      steps_(steps),
      reach_m_(reach_m),
      stretch_(stretch),
      task_(task),
      speed_mps_(
          std::min(task.speed_mps, speed_limit_mps(plan, task.who, stretch.beats().front(), stretch.beats().back()))) {
  const std::vector<Instant>& beats = stretch.beats();
  const auto last = static_cast<std::uint32_t>(beats.size() - 1);
  while (first_ < last && beats[first_] < task.earliest) ++first_;
  last_ = last;
  while (last_ > first_ && beats[last_] > task.latest) --last_;
  for (const GivenWay& one : task.given) {
    std::vector<Knot> knots = one.who == task.who ? std::vector<Knot>{} : stretch.knots_of(one.marks);
    if (knots.size() >= 2) given_.emplace_back(one.who, std::move(knots));
  }
  find_goals();
}

void WayInSearch::find_goals() {
  const std::vector<Mark>& track = plan_.tracks[task_.who.at()];
  for (std::uint32_t k = first_; k <= last_; ++k) {
    if (const auto cell = cell_at(track, beat(k))) goals_.push_back({beat(k), *cell, true});
  }
  const auto& beats = stretch_.beats();
  for (const Mark& mark : track) {
    if (mark.time <= begins() || mark.time > ends() || std::binary_search(beats.begin(), beats.end(), mark.time)) {
      continue;
    }
    goals_.push_back({mark.time, mark.cell, false});
  }
  std::sort(goals_.begin(), goals_.end(), [](const Goal& a, const Goal& b) { return a.time < b.time; });
  std::erase_if(goals_, [&](const Goal& goal) { return !ways_.can_stand(goal.cell); });
}

const WayInSearch::Goal* WayInSearch::soonest(CellIndex cell, Instant time) const {
  auto goal =
      std::lower_bound(goals_.begin(), goals_.end(), time, [](const Goal& one, Instant at) { return one.time < at; });
  const Point here = grid_.centre(cell);
  for (; goal != goals_.end(); ++goal) {
    if (distance(here, grid_.centre(goal->cell)) <= reach_of(goal->time - time)) return &*goal;
  }
  return nullptr;
}

std::optional<std::vector<Mark>> WayInSearch::to_own_walk() { return search(Aim::own_walk); }
std::optional<std::vector<Mark>> WayInSearch::to_refuge() { return search(Aim::refuge); }

std::optional<std::vector<Mark>> WayInSearch::search(Aim aim) {
  aim_ = aim;
  states_.clear();
  closed_.clear();
  queue_ = {};
  push({task_.from, begins(), first_, 0, 0, true});
  while (!queue_.empty() && closed_.size() < WaysIn::kMostStates) {
    const std::uint32_t n = queue_.top().state;
    queue_.pop();
    const State here = states_[n];
    const bool on_beat = here.beat != kOffBeat;
    const std::uint64_t place = (std::uint64_t{here.cell.value()} << 32U) | here.beat;
    if (on_beat && closed_.count(place) > 0) continue;
    if (!here.looked_at) {
      const State& before = states_[here.before];
      if (!clear({before.time, before.cell}, {here.time, here.cell})) continue;
    }
    if (on_beat) closed_.insert(place);
    if (arrived(here)) {
      std::vector<Mark> marks = marks_to(n);
      simplify(marks);
      return marks;
    }
    expand(n);
  }
  return std::nullopt;
}

bool WayInSearch::arrived(const State& state) const {
  if (aim_ == Aim::refuge) return state.beat == last_;
  if (state.beat == kOffBeat) return true;
  const Goal* goal = soonest(state.cell, state.time);
  return goal != nullptr && goal->time == state.time && goal->cell == state.cell;
}

void WayInSearch::push(State state) {
  Entry entry{state.time, state.walked_m, state.time, static_cast<std::uint32_t>(states_.size())};
  if (aim_ == Aim::refuge) {
    entry.joins = {};
  } else {
    const Goal* goal = soonest(state.cell, state.time);
    if (goal == nullptr) return;
    entry.joins = goal->time;
    entry.way_m += distance(grid_.centre(state.cell), grid_.centre(goal->cell));
  }
  states_.push_back(state);
  queue_.push(entry);
}

void WayInSearch::expand(std::uint32_t n) {
  const State here = states_[n];
  if (aim_ == Aim::own_walk) shoot(n);
  if (here.beat >= last_) return;
  push({here.cell, beat(here.beat + 1), here.beat + 1, n, here.walked_m});
  std::uint32_t there = here.beat + 1;
  std::vector<std::pair<CellIndex, double>> nexts;
  steps_.each_next(here.cell.value(), [&](std::uint32_t cell, float) {
    nexts.emplace_back(CellIndex(cell), distance(grid_.centre(here.cell), grid_.centre(CellIndex(cell))));
  });
  std::stable_sort(nexts.begin(), nexts.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  for (const auto& [cell, walk_m] : nexts) {
    while (there <= last_ && reach_of(beat(there) - here.time) < walk_m) ++there;
    if (there > last_) return;
    push({cell, beat(there), there, n, here.walked_m + walk_m});
  }
}

/// Straight to where her own walk can be met soonest, and to marks between beats, which no whole beats lead to.
void WayInSearch::shoot(std::uint32_t n) {
  const State here = states_[n];
  const Point at = grid_.centre(here.cell);
  const auto to = [&](const Goal& goal) {
    const auto& beats = stretch_.beats();
    const auto found = std::lower_bound(beats.begin(), beats.end(), goal.time);
    const std::uint32_t on = goal.on_beat ? static_cast<std::uint32_t>(found - beats.begin()) : kOffBeat;
    push({goal.cell, goal.time, on, n, here.walked_m + distance(at, grid_.centre(goal.cell))});
  };
  const Goal* best = soonest(here.cell, here.time);
  if (best == nullptr || best->time <= here.time) return;
  to(*best);
  for (const Goal& goal : goals_) {
    if (goal.on_beat || &goal == best || goal.time <= here.time) continue;
    const double walk_m = distance(at, grid_.centre(goal.cell));
    if (walk_m <= reach_m_ && walk_m <= reach_of(goal.time - here.time)) to(goal);
  }
}

bool WayInSearch::can_walk(const Mark& from, const Mark& to) const {
  const Point a = grid_.centre(from.cell);
  const Point b = grid_.centre(to.cell);
  return distance(a, b) <= reach_of(to.time - from.time) &&
         (ways_.open() || from.cell == to.cell || ways_.straight(a, b));
}

bool WayInSearch::clear(const Mark& from, const Mark& to) const {
  if (from.time == to.time) return from.cell == to.cell;
  if (!can_walk(from, to)) return false;
  const WaysIn::Stretch::Part part{{stretch_.share_of(from.time), grid_.centre(from.cell)},
                                   {stretch_.share_of(to.time), grid_.centre(to.cell)}};
  for (const auto& [who, knots] : given_) {
    if (!stretch_.clear_of(task_.who, part, who, knots)) return false;
  }
  return stretch_.clear(task_.who, part);
}

std::vector<Mark> WayInSearch::marks_to(std::uint32_t n) const {
  std::vector<Mark> marks;
  for (;; n = states_[n].before) {
    marks.push_back({states_[n].time, states_[n].cell});
    if (n == 0) break;
  }
  std::reverse(marks.begin(), marks.end());
  return marks;
}

/// Leaves out corners without which nobody is met either, and marks in the middle of a wait.
void WayInSearch::simplify(std::vector<Mark>& marks) const {
  for (std::size_t k = 1; k + 1 < marks.size();) {
    const bool waits = marks[k - 1].cell == marks[k].cell;
    const bool waits_on = marks[k].cell == marks[k + 1].cell;
    // A wait before a walk keeps its end: to set out later and to walk slower are not the same.
    const bool needed = waits != waits_on;
    if (!needed && clear(marks[k - 1], marks[k + 1])) {
      marks.erase(marks.begin() + static_cast<std::ptrdiff_t>(k));
    } else {
      ++k;
    }
  }
}

}  // namespace footlight::planner
