// SPDX-License-Identifier: Apache-2.0
#include "planner/swarm/crowd_best.hpp"

#include "planner/swarm/equations.hpp"

namespace footlight::planner::swarm {

void CrowdBest::improve(const Landscape& landscape, std::span<const Point> best, std::span<const double> best_weighed,
                        std::span<const std::uint32_t> place, std::span<const Point> shifts) {
  std::vector<double> least;
  for (std::size_t c = 0; c < offset.size(); ++c) least.push_back(landscape.value(weighed[c], length(offset[c])));
  for (std::size_t p = 0; p < best.size(); ++p) {
    const std::uint32_t crowd = landscape.crowd(p);
    const Point from_target = best[p] - landscape.target(place[p], shifts[crowd]);
    const double own = landscape.value(best_weighed[p], length(from_target));
    if (own >= least[crowd]) continue;
    least[crowd] = own;
    offset[crowd] = from_target;
    weighed[crowd] = best_weighed[p];
  }
}

}  // namespace footlight::planner::swarm
