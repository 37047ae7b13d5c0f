// SPDX-License-Identifier: Apache-2.0
#include "planner/collective/timed_ways.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace footlight::planner::collective {
namespace {

using Corner = TimedWays::Corner;

/// Where the middle of a group is, and when.
struct GroupWay {
  Point from;  ///< middle of its people
  Point to;    ///< middle of their places
  std::vector<Point> through;
  std::vector<double> share;  ///< of the whole way, at each of `through`
};

const GroupPath* path_of(const MotionTask& task, std::uint32_t group) {
  const GroupPath* of_all = nullptr;
  for (const GroupPath& path : task.paths) {
    if (path.group && path.group->value() == group) return &path;
    if (!path.group) of_all = &path;
  }
  return of_all;
}

/// People who share a path move about one middle.
std::map<const GroupPath*, GroupWay> group_ways(const MotionTask& task, std::span<const Point> to) {
  std::map<const GroupPath*, GroupWay> out;
  std::map<const GroupPath*, double> people;
  for (std::size_t i = 0; i < task.people(); ++i) {
    const GroupPath* path = path_of(task, task.group[i]);
    if (path == nullptr) continue;
    out[path].from = out[path].from + task.from[i];
    out[path].to = out[path].to + to[i];
    ++people[path];
  }
  for (auto& [path, way] : out) {
    way.from = 1 / people[path] * way.from;
    way.to = 1 / people[path] * way.to;
    way.through = path->through;
    double walked = 0;
    Point last = way.from;
    for (const Point at : way.through) {
      way.share.push_back(walked += distance(last, at));
      last = at;
    }
    const double whole = walked + distance(last, way.to);
    for (double& share : way.share) share = whole > 0 ? share / whole : 1;
  }
  return out;
}

/// On the floor, off what is blocked: there or at the nearest cell.
std::optional<Point> somewhere_to_stand(const MotionFloor& floor, Point at) {
  const Point inside{std::clamp(at.x, floor.low().x, floor.high().x), std::clamp(at.y, floor.low().y, floor.high().y)};
  const Ways& ways = floor.ways();
  if (ways.open() || ways.straight(inside, inside)) return inside;
  const Grid& grid = ways.grid();
  for (double radius_m = grid.pitch_m(); radius_m < 64 * grid.pitch_m(); radius_m *= 2) {
    std::optional<Point> best;
    for (const CellIndex cell : grid.within(inside, radius_m)) {
      if (!ways.can_stand(cell)) continue;
      const Point centre = grid.centre(cell);
      if (!best || distance(centre, inside) < distance(*best, inside)) best = centre;
    }
    if (best) return best;
  }
  return std::nullopt;
}

Error unreachable(Point begin, Point from, Point to) {
  return input_error(
      fmt::format("whoever stands at [{:g} m, {:g} m] cannot get from [{:g} m, {:g} m] to [{:g} m, {:g} "
                  "m]: blocked cells are all around (open a way)",
                  begin.x, begin.y, from.x, from.y, to.x, to.y));
}

/// Times of the corners in between by their length, and what is left to the end of each leg.
void time_corners(std::vector<Corner>& way) {
  std::size_t begin = 0;
  for (std::size_t end = 1; end < way.size(); ++end) {
    if (!way[end].timed) continue;
    double left = 0;
    for (std::size_t k = end; k > begin; --k) {
      way[k - 1].left_m = left += distance(way[k - 1].at, way[k].at);
      way[k - 1].end_s = way[end].at_s;
    }
    for (std::size_t k = begin + 1; k < end; ++k) {
      const double walked = left > 0 ? 1 - way[k].left_m / left : 0;
      way[k].at_s = way[begin].at_s + walked * (way[end].at_s - way[begin].at_s);
    }
    begin = end;
  }
  way.back().left_m = 0;
  way.back().end_s = way.back().at_s;
}

}  // namespace

void TimedWays::append(std::vector<Corner> way) {
  time_corners(way);
  corners_.insert(corners_.end(), way.begin(), way.end());
  first_.push_back(static_cast<std::uint32_t>(corners_.size()));
}

Result<TimedWays> TimedWays::make(const MotionTask& task, std::span<const Point> to, const WalkField* around,
                                  double arrive_s) {
  TimedWays out;
  const auto groups = group_ways(task, to);
  for (std::size_t i = 0; i < task.people(); ++i) {
    std::vector<Corner> legs{{task.from[i], 0}};
    const auto path = groups.find(path_of(task, task.group[i]));
    for (std::size_t k = 0; path != groups.end() && k < path->second.through.size(); ++k) {
      const GroupWay& way = path->second;
      const double u = way.share[k];
      const Point aim = way.through[k] + (1 - u) * (task.from[i] - way.from) + u * (to[i] - way.to);
      const auto at = somewhere_to_stand(*task.floor, aim);
      if (at) legs.push_back({*at, u * arrive_s});
    }
    legs.push_back({to[i], arrive_s});
    std::vector<Corner> corners{legs.front()};
    for (std::size_t k = 1; k < legs.size(); ++k) {
      const std::vector<Point> taut =
          around == nullptr ? std::vector{legs[k - 1].at, legs[k].at} : around->way(legs[k - 1].at, legs[k].at);
      if (taut.empty()) return unreachable(task.from[i], legs[k - 1].at, legs[k].at);
      for (std::size_t c = 1; c + 1 < taut.size(); ++c) corners.push_back({taut[c], 0, 0, 0, false});
      corners.push_back(legs[k]);
    }
    out.append(std::move(corners));
  }
  return out;
}

Point TimedWays::place(std::size_t person, double at_s) const {
  const std::span<const Corner> way = of(person);
  const auto after = std::upper_bound(way.begin(), way.end(), at_s,
                                      [](double time_s, const Corner& corner) { return time_s < corner.at_s; });
  if (after == way.begin()) return way.front().at;
  if (after == way.end()) return way.back().at;
  const Corner& before = *std::prev(after);
  return before.at + (at_s - before.at_s) / (after->at_s - before.at_s) * (after->at - before.at);
}

void TimedWays::step_aside(std::span<const std::uint32_t> who, const Aside& aside, const MotionFloor& floor) {
  std::vector<char> moved(people(), 0);
  for (const std::uint32_t person : who) moved[person] = 1;
  TimedWays out;
  for (std::size_t i = 0; i < people(); ++i) {
    std::vector<Corner> way = moved[i] != 0 ? stepped_aside(i, aside) : std::vector<Corner>{};
    bool free = !way.empty();
    for (std::size_t k = 0; free && k + 1 < way.size(); ++k) {
      free = floor.ways().straight(way[k].at, way[k + 1].at) && floor.free_share(way[k].at, way[k + 1].at) >= 1;
    }
    const std::span<const Corner> old = of(i);
    out.append(free ? std::move(way) : std::vector<Corner>(old.begin(), old.end()));
  }
  *this = std::move(out);
}

std::vector<Corner> TimedWays::stepped_aside(std::size_t person, const Aside& aside) const {
  const std::span<const Corner> old = of(person);
  // A way around something blocked is left alone.
  if (!std::all_of(old.begin(), old.end(), [](const Corner& corner) { return corner.timed; })) return {};
  const double last_s = old.back().at_s;
  std::vector<Corner> inner(old.begin() + 1, old.end() - 1);
  for (Corner& corner : inner) {
    if (corner.at_s > aside.from_s && corner.at_s < aside.until_s) corner.at = corner.at + aside.by;
  }
  const auto add = [&](double time_s, Point by) {
    if (time_s > 0 && time_s < last_s) inner.push_back({place(person, time_s) + by, time_s});
  };
  add(aside.from_s - aside.lead_s, {});
  add(aside.from_s, aside.by);
  add(aside.until_s, aside.by);
  add(aside.until_s + aside.lead_s, {});
  std::stable_sort(inner.begin(), inner.end(), [](const Corner& a, const Corner& b) { return a.at_s < b.at_s; });
  std::vector<Corner> way{old.front()};
  way.insert(way.end(), inner.begin(), inner.end());
  way.push_back(old.back());
  return way;
}

}  // namespace footlight::planner::collective
