// SPDX-License-Identifier: Apache-2.0
#include "planner/way_in/stretch.hpp"

#include <array>

#include "core/check.hpp"

namespace footlight::planner {
namespace {

constexpr double kRounding_m = 1e-9;

/// No two people keep more.
double widest_m(const Plan& plan) {
  double first = 0;
  double second = 0;
  for (const double radius : plan.radius_m) {
    second = std::max(second, std::min(first, radius));
    first = std::max(first, radius);
  }
  return std::max(plan.stage.clearance_m, first + second);
}

/// Nobody walks further in the whole time.
double fastest_m(const std::vector<std::vector<Knot>>& paths) {
  double fastest = 0;
  for (const std::vector<Knot>& path : paths) {
    for (std::size_t k = 0; k + 1 < path.size(); ++k) {
      fastest = std::max(fastest, distance(path[k].point, path[k + 1].point) / (path[k + 1].at - path[k].at));
    }
  }
  return fastest;
}

std::vector<double> shares_of(const std::vector<Instant>& beats) {
  FL_CHECK(beats.size() >= 2 && std::is_sorted(beats.begin(), beats.end(), std::less_equal<>()));
  std::vector<double> shares;
  const double time_s = to_seconds(beats.back() - beats.front());
  for (const Instant beat : beats) shares.push_back(to_seconds(beat - beats.front()) / time_s);
  return shares;
}

std::vector<std::vector<Knot>> paths_of(const Plan& plan, const std::vector<Instant>& beats) {
  const Instant start = beats.front();
  const Instant end = beats.back();
  const double time_s = to_seconds(end - start);
  std::vector<std::vector<Knot>> paths;
  paths.reserve(plan.tracks.size());
  for (const std::vector<Mark>& track : plan.tracks) {
    FL_CHECK(!track.empty());
    std::vector<Knot>& path = paths.emplace_back();
    path.push_back({0, position_at(plan.stage.grid, track, start)});
    auto mark =
        std::upper_bound(track.begin(), track.end(), start, [](Instant at, const Mark& one) { return at < one.time; });
    for (; mark != track.end() && mark->time < end; ++mark) {
      path.push_back({to_seconds(mark->time - start) / time_s, plan.stage.grid.centre(mark->cell)});
    }
    path.push_back({1, position_at(plan.stage.grid, track, end)});
  }
  return paths;
}

}  // namespace

WaysIn::Stretch::Stretch(const Plan& plan, std::vector<Instant> beats, double lag_s)
    : plan_(plan),
      beats_(std::move(beats)),
      time_s_(to_seconds(beats_.back() - beats_.front())),
      late_share_(std::min(1.0, lag_s / time_s_)),
      at_(shares_of(beats_)),
      paths_(paths_of(plan, beats_)),
      slabs_(plan.stage.grid, at_, paths_, widest_m(plan), late_share_, fastest_m(paths_)) {
  for (const PlanSection& section : plan.sections) add_obstacles(section);
  slabs_.fill_all();
}

void WaysIn::Stretch::add_obstacles(const PlanSection& section) {
  const Instant start = std::max(section.start, beats_.front());
  const Instant end = std::min(section.end, beats_.back());
  if (start >= end) return;
  for (const PlanObstacle& obstacle : section.obstacles) {
    if (obstacle.at.empty()) continue;
    const auto place = [&](Instant time) {
      const auto after = std::upper_bound(obstacle.at.begin(), obstacle.at.end(), time,
                                          [](Instant at, const PlanObstacle::At& one) { return at < one.time; });
      if (after == obstacle.at.begin()) return after->centre;
      const PlanObstacle::At& before = *(after - 1);
      if (after == obstacle.at.end()) return before.centre;
      const double share = to_seconds(time - before.time) / to_seconds(after->time - before.time);
      return before.centre + share * (after->centre - before.centre);
    };
    Moving moving{obstacle.radius_m, {{share_of(start), place(start)}}};
    for (const PlanObstacle::At& at : obstacle.at) {
      if (at.time > start && at.time < end) moving.path.push_back({share_of(at.time), at.centre});
    }
    moving.path.push_back({share_of(end), place(end)});
    moving_.push_back(std::move(moving));
  }
}

std::vector<Knot> WaysIn::Stretch::knots_of(std::span<const Mark> marks) const {
  if (marks.empty() || marks.back().time <= beats_.front()) return {};
  const std::vector<Mark> track(marks.begin(), marks.end());
  const Grid& grid = plan_.stage.grid;
  std::vector<Knot> path{{0, position_at(grid, track, beats_.front())}};
  for (const Mark& mark : track) {
    if (mark.time > beats_.front() && mark.time < beats_.back()) {
      path.push_back({share_of(mark.time), grid.centre(mark.cell)});
    }
  }
  if (track.back().time >= beats_.back()) path.push_back({1, position_at(grid, track, beats_.back())});
  return path;
}

bool WaysIn::Stretch::clear_of(PerformerIndex who, const Part& part, PerformerIndex other,
                               std::span<const Knot> walk) const {
  // Only what she can meet: the pieces of the walk that lie in her time.
  const auto later = [](double at, const Knot& knot) { return at < knot.at; };
  const auto earlier = [](const Knot& knot, double at) { return knot.at < at; };
  auto first = std::upper_bound(walk.begin(), walk.end(), part.from.at - late_share_, later);
  auto last = std::lower_bound(first, walk.end(), part.to.at + late_share_, earlier);
  if (first != walk.begin()) --first;
  if (last != walk.end()) ++last;
  const auto count = static_cast<std::size_t>(last - first);
  const auto met = walk.subspan(static_cast<std::size_t>(first - walk.begin()), count);
  const double least_m = least_distance_of(plan_, who, other) - kRounding_m;
  return least_squared_along_m2(std::array{part.from, part.to}, met, late_share_) >= least_m * least_m;
}

bool WaysIn::Stretch::clear_of_obstacles(PerformerIndex who, const Part& part) const {
  const double keep_m = std::max(plan_.stage.clearance_m / 2, plan_.radius_m[who.at()]);
  return std::all_of(moving_.begin(), moving_.end(), [&](const Moving& moving) {
    const double least_m = moving.radius_m + keep_m;
    return least_squared_along_m2(std::array{part.from, part.to}, moving.path, late_share_) >= least_m * least_m;
  });
}

bool WaysIn::Stretch::clear(PerformerIndex who, const Part& part) const {
  if (!moving_.empty() && !clear_of_obstacles(who, part)) return false;
  const Point velocity = 1 / (part.to.at - part.from.at) * (part.to.point - part.from.point);
  const double walk_m = length(velocity);
  const auto begin = std::upper_bound(at_.begin() + 1, at_.end() - 1, part.from.at);
  bool free = true;
  for (auto slab = static_cast<std::size_t>(begin - at_.begin()) - 1;
       free && slab + 1 < at_.size() && at_[slab] < part.to.at; ++slab) {
    const double middle = (at_[slab] + at_[slab + 1]) / 2;
    slabs_.visit_filled(slab, part.from.point + (middle - part.from.at) * velocity, walk_m, [&](std::uint32_t other) {
      if (!free || other == who.value()) return;
      free = clear_of(who, part, PerformerIndex(other), paths_[other]);
    });
  }
  return free;
}

}  // namespace footlight::planner
