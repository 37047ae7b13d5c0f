// SPDX-License-Identifier: Apache-2.0
#include "controller/tempo_limit.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "controller/cue_engine.hpp"

namespace footlight::controller {
namespace {

/// A plan may use its limit up to a millionth.
int percent_of(double share) { return std::max(100, static_cast<int>(std::floor(share * 100 + 1e-3))); }

double limit_mps(const Plan& plan, std::size_t performer, Instant end) {
  if (plan.max_speed_mps[performer] > 0) return plan.max_speed_mps[performer];
  const auto section = std::ranges::find_if(plan.sections, [&](const PlanSection& one) { return one.end >= end; });
  const double own = section == plan.sections.end() ? 0 : section->max_speed_mps;
  return own > 0 ? own : plan.stage.max_speed_mps;
}

}  // namespace

std::vector<TempoLimit> tempo_limits(const Plan& plan, const TempoMap& tempo, const std::vector<CuePlay>& plays,
                                     const CueSchedule& schedule, const std::vector<BusNeed>& needs, const Rig& rig) {
  std::vector<TempoLimit> limits(plays.size(), TempoLimit{kFastest_percent, {}});
  for (std::size_t p = 0; p < plan.tracks.size(); ++p) {
    const auto& track = plan.tracks[p];
    std::size_t cue = 0;
    for (std::size_t m = 0; m + 1 < track.size(); ++m) {
      if (track[m].cell == track[m + 1].cell) continue;
      while (cue + 1 < plays.size() && plays[cue].to < track[m + 1].time) ++cue;
      const Grid& grid = plan.stage.grid;
      const double speed_mps = distance(grid.centre(track[m].cell), grid.centre(track[m + 1].cell)) /
                               to_seconds(track[m + 1].time - track[m].time);
      const double limit = limit_mps(plan, p, track[m + 1].time);
      const int percent = percent_of(limit / speed_mps);
      if (percent >= limits[cue].percent) continue;
      limits[cue] = {percent, fmt::format("performer {} walks at {:.2f} of {:.3g} m/s at count {:.4g}",
                                          plan.performers[p], speed_mps, limit, tempo.count_at(track[m].time))};
    }
  }
  for (const BusNeed& need : needs) {
    if (need.changed == 0 || need.k == 0 || schedule.switches()[need.k - 1].settled) continue;
    const std::optional<std::size_t> cue = schedule.switches()[need.k].cue;
    if (!cue) continue;
    const int percent = percent_of(to_seconds(need.allowed()) / std::max(1e-9, to_seconds(need.needed())));
    if (percent >= limits[*cue].percent) continue;
    limits[*cue] = {percent, fmt::format("bus \"{}\" needs {:.0f} of {:.0f} ms for {}", rig.buses[need.bus.at()].name,
                                         to_seconds(need.needed()) * 1e3, to_seconds(need.allowed()) * 1e3,
                                         schedule.switches()[need.k].cause)};
  }
  return limits;
}

}  // namespace footlight::controller
