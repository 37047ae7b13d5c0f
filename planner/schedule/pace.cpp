// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/pace.hpp"

#include <algorithm>

namespace footlight::planner {

double paced_m(double longest_m, double pitch_m) { return std::max(longest_m - 0.75 * pitch_m, 0.5 * longest_m); }

std::vector<std::vector<Wanted>> leave_early(const Ways& ways, const std::vector<PaceInstant>& instants,
                                             const CellFlags& reserve) {
  const Grid& grid = ways.grid();
  std::vector<std::vector<Wanted>> wanted(instants.size());
  for (std::size_t back = 0; back < instants.size(); ++back) {
    const std::size_t k = instants.size() - 1 - back;
    const PaceInstant& here = instants[k];
    wanted[k].resize(here.own.size());
    for (std::size_t i = 0; i < here.own.size(); ++i) {
      const CellIndex own = here.own[i];
      wanted[k][i] = {grid.centre(own), true};
      if (here.exact || back == 0 || reserve[own.at()] == 0) continue;
      const Point next = wanted[k + 1][i].at;
      if (distance(next, grid.centre(own)) <= here.longest_m && ways.straight(next, grid.centre(own))) continue;
      const Ways::Step step = ways.toward(next, grid.centre(own), paced_m(here.longest_m, grid.pitch_m()));
      if (step.length_m > here.longest_m) wanted[k][i] = {step.at, false};
    }
  }
  return wanted;
}

}  // namespace footlight::planner
