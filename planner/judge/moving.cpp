// SPDX-License-Identifier: Apache-2.0
#include "planner/judge/moving.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace footlight::planner::judge {
namespace {

Point between(Point a, Point b, Instant start, Instant end, Instant at) {
  return end > start ? a + to_seconds(at - start) / to_seconds(end - start) * (b - a) : a;
}

Point centre_at(const PlanObstacle& obstacle, Instant at) {
  const auto& marks = obstacle.at;
  std::size_t next = 0;
  while (next < marks.size() && marks[next].time <= at) ++next;
  if (next == 0) return marks.front().centre;
  if (next == marks.size()) return marks.back().centre;
  return between(marks[next - 1].centre, marks[next].centre, marks[next - 1].time, marks[next].time, at);
}

/// Least distance of the middles while both go straight.
struct Nearest {
  double squared_m2 = std::numeric_limits<double>::infinity();
  Instant at;

  void look(Point apart_at_start, Point apart_at_end, Instant start, Instant end) {
    const Point change = apart_at_end - apart_at_start;
    const double length2 = squared_length(change);
    const double share = length2 > 0 ? std::clamp(-dot(apart_at_start, change) / length2, 0.0, 1.0) : 0.0;
    const double found_m2 = squared_length(apart_at_start + share * change);
    if (found_m2 >= squared_m2) return;
    squared_m2 = found_m2;
    at = start + seconds(share * to_seconds(end - start));
  }
};

}  // namespace

std::vector<MovingObstacles::Hit> MovingObstacles::nearer_than(const Stand& from, const Stand& to,
                                                               double limit_m) const {
  std::vector<Hit> hits;
  for (std::size_t s = 0; s < sections_->size(); ++s) {
    const PlanSection& section = (*sections_)[s];
    const Instant start = std::max(from.time, section.start);
    const Instant end = std::min(to.time, section.end);
    if (section.obstacles.empty() || start > end) continue;
    for (std::size_t o = 0; o < section.obstacles.size(); ++o) {
      const PlanObstacle& obstacle = section.obstacles[o];
      if (obstacle.at.empty()) continue;
      std::vector<Instant> cuts{start};
      for (const PlanObstacle::At& mark : obstacle.at) {
        if (mark.time > start && mark.time < end) cuts.push_back(mark.time);
      }
      cuts.push_back(end);
      const auto apart = [&](Instant at) {
        return between(from.at, to.at, from.time, to.time, at) - centre_at(obstacle, at);
      };
      Nearest nearest;
      for (std::size_t c = 1; c < cuts.size(); ++c) {
        nearest.look(apart(cuts[c - 1]), apart(cuts[c]), cuts[c - 1], cuts[c]);
      }
      const double least_m = obstacle.radius_m + limit_m;
      if (nearest.squared_m2 >= least_m * least_m) continue;
      hits.push_back({s, o, std::max(0.0, std::sqrt(nearest.squared_m2) - obstacle.radius_m), nearest.at});
    }
  }
  return hits;
}

}  // namespace footlight::planner::judge
