// SPDX-License-Identifier: Apache-2.0
#include "planner/motion/swept_discs.hpp"

#include <algorithm>

#include "core/motion.hpp"

namespace footlight::planner {
namespace {

Point centre_at(const std::vector<MovingObstacle::At>& at, const TempoMap& tempo, Instant when) {
  if (when <= tempo.at(at.front().count)) return at.front().centre;
  for (std::size_t n = 1; n < at.size(); ++n) {
    const Instant start = tempo.at(at[n - 1].count);
    const Instant end = tempo.at(at[n].count);
    if (when > end) continue;
    const double share = end > start ? to_seconds(when - start) / to_seconds(end - start) : 1;
    return at[n - 1].centre + share * (at[n].centre - at[n - 1].centre);
  }
  return at.back().centre;
}

}  // namespace

std::vector<SweptDisc> swept_discs(const Show& show, Instant from, Instant to) {
  std::vector<SweptDisc> out;
  for (const Section& section : show.sections) {
    if (section.motion == nullptr) continue;
    const Instant start = std::max(from, show.tempo.at(section.start_count));
    const Instant end = std::min(to, show.tempo.at(section.end_count()));
    if (start > end) continue;
    for (const MovingObstacle& obstacle : section.motion->obstacles) {
      Point before = centre_at(obstacle.at, show.tempo, start);
      for (const MovingObstacle::At& at : obstacle.at) {
        const Instant when = show.tempo.at(at.count);
        if (when <= start || when >= end) continue;
        out.push_back({before, at.centre, obstacle.radius_m});
        before = at.centre;
      }
      out.push_back({before, centre_at(obstacle.at, show.tempo, end), obstacle.radius_m});
    }
  }
  return out;
}

StageKey floor_with_discs(const StageKey& floor, const std::vector<SweptDisc>& during,
                          const std::vector<SweptDisc>& after) {
  StageHash hash("floor with discs");
  hash.add(floor);
  for (const auto* discs : {&during, &after}) {
    hash.add(discs->size());
    for (const SweptDisc& disc : *discs) {
      hash.add(disc.from.x).add(disc.from.y).add(disc.to.x).add(disc.to.y).add(disc.radius_m);
    }
  }
  return hash.key();
}

bool has_moving_obstacles(const Show& show) {
  return std::any_of(show.sections.begin(), show.sections.end(), [](const Section& section) {
    return section.motion != nullptr && !section.motion->obstacles.empty();
  });
}

}  // namespace footlight::planner
