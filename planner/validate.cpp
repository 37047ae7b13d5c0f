// SPDX-License-Identifier: Apache-2.0
#include "planner/validate.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <tuple>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "planner/judge/approach.hpp"
#include "planner/judge/blocked.hpp"
#include "planner/judge/moving.hpp"
#include "planner/judge/walks.hpp"

namespace footlight::planner {
namespace {

using judge::BlockedFloor;
using judge::Walks;
using Kind = Violation::Kind;

constexpr std::size_t kKept = 100;

std::string figure(double value, const char* unit) {
  char text[64];
  std::snprintf(text, sizeof text, "%.3f %s", value, unit);
  return text;
}
std::string time_text(Instant time) { return figure(to_seconds(time), "s"); }

bool earlier(const Violation& x, const Violation& y) {
  return std::tie(x.time, x.a, x.b, x.kind) < std::tie(y.time, y.a, y.b, y.kind);
}

/// Counts everything and keeps the first.
struct Findings {
  std::uint64_t count = 0;
  std::vector<Violation> first;
  double max_speed_mps = 0;

  void add(Violation violation) {
    ++count;
    first.push_back(std::move(violation));
    if (first.size() >= 8 * kKept) trim();
  }
  void trim() {
    std::stable_sort(first.begin(), first.end(), earlier);
    if (first.size() > kKept) first.resize(kKept);
  }
  void take(Findings&& other) {
    count += other.count;
    max_speed_mps = std::max(max_speed_mps, other.max_speed_mps);
    std::move(other.first.begin(), other.first.end(), std::back_inserter(first));
    trim();
  }
};

class Judge {
 public:
  explicit Judge(const Plan& plan) : plan_(plan), walks_(plan), blocked_(plan.stage), moving_(plan) {
    check_lengths();
    if (walks_.times().empty()) return;
    start_ = walks_.times().front();
    end_ = walks_.times().back();
  }
  Judge(const Plan& plan, Instant start, Instant end)
      : plan_(plan),
        walks_(plan, start, end),
        blocked_(plan.stage),
        moving_(plan),
        start_(start),
        end_(end),
        whole_(false) {
    FL_CHECK(start <= end);
    check_lengths();
  }

  Verdict run() {
    Verdict verdict;
    Findings all = judge_everybody();
    all.take(shared_cells());
    all.take(formations());
    judge::Approaches near;
    if (!walks_.times().empty()) near = judge::find_approaches(plan_, walks_, start_, end_, kKept);
    verdict.min_clearance_m = near.nearest.distance_m;
    verdict.closest_a = PerformerIndex(near.nearest.a);
    verdict.closest_b = PerformerIndex(near.nearest.b);
    verdict.closest_at = near.nearest.at;
    verdict.too_close = near.too_close;
    verdict.max_speed_mps = all.max_speed_mps;
    verdict.violations = all.count + near.too_close;
    for (const judge::NearestPair& pair : near.first) all.first.push_back(too_close(pair));
    all.trim();
    verdict.first = std::move(all.first);
    return verdict;
  }

 private:
  void check_lengths() const {
    const std::size_t people = plan_.tracks.size();
    FL_CHECK(plan_.performers.size() == people && plan_.radius_m.size() == people &&
             plan_.max_speed_mps.size() == people);
  }
  [[nodiscard]] bool judged(Instant at) const { return whole_ || (start_ <= at && at <= end_); }

  [[nodiscard]] std::string who(std::uint32_t person) const { return "performer " + plan_.performers[person]; }
  [[nodiscard]] std::string cell_text(CellIndex cell) const {
    return static_cast<int>(cell.value()) < plan_.stage.grid.size() ? plan_.stage.grid.name(cell)
                                                                    : "cell number " + std::to_string(cell.value());
  }
  /// "from B2 to C5" or "on B2": what somebody does at an instant.
  [[nodiscard]] std::string way_text(std::uint32_t person, Instant time) const {
    const std::size_t before = walks_.stand_before(person, time);
    const auto& track = walks_.track(person);
    const std::string from = plan_.stage.grid.name(plan_.stage.grid.nearest(track[before].at));
    if (before + 1 == track.size() || track[before].time >= time || track[before + 1].at == track[before].at) {
      return "on " + from;
    }
    return "from " + from + " to " + plan_.stage.grid.name(plan_.stage.grid.nearest(track[before + 1].at));
  }

  Findings judge_everybody() const {
    const std::size_t people = plan_.tracks.size();
    std::vector<Findings> parts((people + kBatch - 1) / kBatch);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, parts.size(), 1), [&](const auto& range) {
      for (std::size_t k = range.begin(); k != range.end(); ++k) {
        for (std::size_t i = k * kBatch; i < std::min(people, (k + 1) * kBatch); ++i) {
          const auto person = static_cast<std::uint32_t>(i);
          times(person, parts[k]);
          cells(person, parts[k]);
          walks(person, parts[k]);
        }
      }
    });
    Findings all;
    for (Findings& part : parts) all.take(std::move(part));
    return all;
  }

  void times(std::uint32_t person, Findings& out) const {
    const std::vector<Mark>& track = plan_.tracks[person];
    const PerformerIndex p(person);
    const Instant first = start_;
    const Instant last = end_;
    if (track.empty()) {
      out.add({Kind::times, p, p, first, 0, 0, who(person) + " has no mark"});
      return;
    }
    for (std::size_t k = 1; k < track.size(); ++k) {
      if (track[k].time > track[k - 1].time) continue;
      out.add({Kind::times, p, p, track[k].time, 0, 0,
               who(person) + " has its mark at " + time_text(track[k].time) + " after the one at " +
                   time_text(track[k - 1].time)});
    }
    const auto [begin, end] =
        std::minmax_element(track.begin(), track.end(), [](const Mark& a, const Mark& b) { return a.time < b.time; });
    if (begin->time <= first && end->time >= last) return;
    out.add({Kind::times, p, p, begin->time > first ? begin->time : end->time, 0, 0,
             who(person) + " has marks from " + time_text(begin->time) + " to " + time_text(end->time) +
                 ", the show is from " + time_text(first) + " to " + time_text(last)});
  }

  void cells(std::uint32_t person, Findings& out) const {
    const PerformerIndex p(person);
    for (const Mark& mark : plan_.tracks[person]) {
      if (!judged(mark.time)) continue;
      if (static_cast<int>(mark.cell.value()) >= plan_.stage.grid.size()) {
        out.add({Kind::off_grid, p, p, mark.time, 0, 0,
                 who(person) + " stands off the grid at " + time_text(mark.time) + " (" + cell_text(mark.cell) +
                     " of " + std::to_string(plan_.stage.grid.size()) + ")"});
      } else if (blocked_.contains(mark.cell)) {
        out.add({Kind::blocked_cell, p, p, mark.time, 0, 0,
                 who(person) + " stands on the blocked cell " + cell_text(mark.cell) + " at " + time_text(mark.time)});
      }
    }
  }

  void walks(std::uint32_t person, Findings& out) const {
    const auto& track = walks_.track(person);
    for (std::size_t k = 1; k < track.size(); ++k) {
      walk_speed(person, track[k - 1], track[k], out);
      if (!blocked_.empty()) walk_blocked(person, track[k - 1], track[k], out);
      walk_into_moving(person, track[k - 1], track[k], out);
    }
    if (track.size() == 1 && !blocked_.empty()) walk_blocked(person, track[0], track[0], out);
  }

  /// A stretch belongs to the section in which it ends; so does a walk from one section into the next.
  [[nodiscard]] double speed_limit(std::uint32_t person, Instant end) const {
    if (plan_.max_speed_mps[person] > 0) return plan_.max_speed_mps[person];
    for (const PlanSection& section : plan_.sections) {
      if (end <= section.end) return section.max_speed_mps > 0 ? section.max_speed_mps : plan_.stage.max_speed_mps;
    }
    return plan_.stage.max_speed_mps;
  }

  void walk_speed(std::uint32_t person, const judge::Stand& from, const judge::Stand& to, Findings& out) const {
    const double way_m = distance(from.at, to.at);
    const double time_s = to_seconds(to.time - from.time);
    const double speed = way_m / time_s;
    out.max_speed_mps = std::max(out.max_speed_mps, speed);
    const double limit = speed_limit(person, to.time);
    if (speed <= limit * (1 + judge::kSpeedTolerance)) return;
    const PerformerIndex p(person);
    const Grid& grid = plan_.stage.grid;
    out.add({Kind::too_fast, p, p, from.time, speed, limit,
             who(person) + " walks " + figure(way_m, "m") + " from " + grid.name(grid.nearest(from.at)) + " to " +
                 grid.name(grid.nearest(to.at)) + " in " + figure(time_s, "s") + " at " + time_text(from.time) + ": " +
                 figure(speed, "m/s") + " (at most " + figure(limit, "m/s") + ")"});
  }

  /// Counted once for each stretch between neighbouring mark instants, whoever's marks they are, as other judges do.
  void walk_blocked(std::uint32_t person, const judge::Stand& from, const judge::Stand& to, Findings& out) const {
    const double limit = std::max(plan_.stage.clearance_m / 2, plan_.radius_m[person]);
    if (blocked_.nearer_than(from.at, to.at, limit - judge::kBlockedTolerance_m).empty()) return;
    const auto& cuts = walks_.times();
    auto cut = std::upper_bound(cuts.begin(), cuts.end(), from.time);
    Instant start = from.time;
    do {
      const Instant end = cut == cuts.end() ? to.time : std::min(*cut++, to.time);
      const std::size_t before = walks_.stand_before(person, from.time);
      const Point a = walks_.position(person, before, start);
      const Point b = walks_.position(person, before, end);
      for (const BlockedFloor::Hit& hit : blocked_.nearer_than(a, b, limit - judge::kBlockedTolerance_m)) {
        const PerformerIndex p(person);
        out.add({Kind::into_blocked, p, p, start, hit.distance_m, limit,
                 who(person) + " comes " + figure(hit.distance_m, "m") + " near the blocked cell " +
                     cell_text(hit.cell) + " on the way " + way_text(person, start + (end - start) / 2) + " at " +
                     time_text(start) + " (at least " + figure(limit, "m") + ")"});
      }
      start = end;
    } while (start < to.time);
  }

  void walk_into_moving(std::uint32_t person, const judge::Stand& from, const judge::Stand& to, Findings& out) const {
    const double limit = std::max(plan_.stage.clearance_m / 2, plan_.radius_m[person]);
    for (const judge::MovingObstacles::Hit& hit : moving_.nearer_than(from, to, limit - judge::kBlockedTolerance_m)) {
      const PerformerIndex p(person);
      out.add({Kind::into_obstacle, p, p, hit.at, hit.distance_m, limit,
               who(person) + " comes " + figure(hit.distance_m, "m") + " near the moving obstacle " +
                   std::to_string(hit.obstacle + 1) + " of section '" + plan_.sections[hit.section].name + "' " +
                   way_text(person, hit.at) + " at " + time_text(hit.at) + " (at least " + figure(limit, "m") + ")"});
    }
  }

  Findings shared_cells() const {
    struct Place {
      Instant time;
      CellIndex cell;
      std::uint32_t person;
      auto operator<=>(const Place&) const = default;
    };
    const auto& cuts = walks_.times();
    std::vector<std::vector<Place>> at(cuts.size());
    for (std::size_t k = 0; k < cuts.size(); ++k) at[k].reserve(walks_.marks_at()[k]);
    for (std::uint32_t i = 0; i < walks_.people(); ++i) {
      std::size_t k = 0;
      for (const Mark& mark : plan_.tracks[i]) {
        if (k >= cuts.size() || cuts[k] > mark.time) k = 0;
        while (k < cuts.size() && cuts[k] < mark.time) ++k;
        if (k < cuts.size() && cuts[k] == mark.time && judged(mark.time)) at[k].push_back({mark.time, mark.cell, i});
      }
    }
    std::vector<Findings> parts(cuts.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, cuts.size()), [&](const auto& range) {
      for (std::size_t k = range.begin(); k != range.end(); ++k) {
        std::sort(at[k].begin(), at[k].end());
        for (std::size_t i = 1; i < at[k].size(); ++i) {
          const Place& p = at[k][i - 1];
          const Place& q = at[k][i];
          if (p.cell != q.cell || p.person == q.person) continue;
          parts[k].add({Kind::same_cell, PerformerIndex(p.person), PerformerIndex(q.person), p.time, 0, 0,
                        "performers " + plan_.performers[p.person] + " and " + plan_.performers[q.person] +
                            " stand on one cell, " + cell_text(p.cell) + ", at " + time_text(p.time)});
        }
      }
    });
    Findings all;
    for (Findings& part : parts) {
      if (part.count > 0) all.take(std::move(part));
    }
    return all;
  }

  Findings formations() const {
    Findings out;
    for (const Formation& formation : plan_.formations) {
      if (!judged(formation.time)) continue;
      if (formation.cells.size() != plan_.tracks.size()) {
        out.add({Kind::wrong_formation, PerformerIndex{}, PerformerIndex{}, formation.time, 0, 0,
                 "formation " + formation.id + " has " + std::to_string(formation.cells.size()) + " cells for " +
                     std::to_string(plan_.tracks.size()) + " performers"});
        continue;
      }
      for (std::uint32_t i = 0; i < walks_.people(); ++i) formation_of(formation, i, out);
    }
    return out;
  }

  void formation_of(const Formation& formation, std::uint32_t person, Findings& out) const {
    const auto& track = walks_.track(person);
    const CellIndex cell = formation.cells[person];
    const bool on_grid = static_cast<int>(cell.value()) < plan_.stage.grid.size();
    if (on_grid && !track.empty() && walks_.position(person, formation.time) == plan_.stage.grid.centre(cell)) return;
    const PerformerIndex p(person);
    out.add({Kind::wrong_formation, p, p, formation.time, 0, 0,
             "formation " + formation.id + " at " + time_text(formation.time) + " has " + who(person) + " on " +
                 cell_text(cell) + ", whose marks say " +
                 (track.empty() ? std::string("nothing") : way_text(person, formation.time))});
  }

  [[nodiscard]] Violation too_close(const judge::NearestPair& pair) const {
    const double limit = judge::least_distance_m(plan_, pair.a, pair.b);
    return {Kind::too_close,
            PerformerIndex(pair.a),
            PerformerIndex(pair.b),
            pair.at,
            pair.distance_m,
            limit,
            "performers " + plan_.performers[pair.a] + " (" + way_text(pair.a, pair.at) + ") and " +
                plan_.performers[pair.b] + " (" + way_text(pair.b, pair.at) + ") come " + figure(pair.distance_m, "m") +
                " near at " + time_text(pair.at) + " (at least " + figure(limit, "m") + ")"};
  }

  static constexpr std::size_t kBatch = 64;
  const Plan& plan_;
  Walks walks_;
  BlockedFloor blocked_;
  judge::MovingObstacles moving_;
  Instant start_ = kStart;
  Instant end_ = kStart;
  bool whole_ = true;  ///< also what lies outside of everybody's marks
};

}  // namespace

Verdict validate(const Plan& plan) { return Judge(plan).run(); }

Verdict validate(const Plan& plan, Instant start, Instant end) { return Judge(plan, start, end).run(); }

ClosestApproach closest_approach(const Plan& plan, Instant start, Instant end) {
  FL_CHECK(start <= end);
  const judge::NearestPair near = judge::find_approaches(plan, Walks(plan, start, end), start, end, 0).nearest;
  return {near.distance_m, PerformerIndex(near.a), PerformerIndex(near.b), near.at};
}

}  // namespace footlight::planner
