// SPDX-License-Identifier: Apache-2.0
#include "controller/tempo_limit.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "controller/cue_engine.hpp"
#include "controller/flash_rate.hpp"

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

std::string name_of(const Channel& channel, const Plan& plan) {
  return channel.kind == Channel::Kind::cell ? "the lamp on " + plan.stage.grid.name(channel.cell)
                                             : "the wearable of performer " + plan.performers[channel.performer.at()];
}

/// How many switches of the show may matter to what flashes in a cue: its own, the one before, and those in the two
/// seconds after it, which are one at the fastest tempo.
struct CueSwitches {
  std::size_t first = 0;
  std::size_t end = 0;
};

std::vector<CueSwitches> switches_of(const CueSchedule& schedule, std::size_t cues) {
  const auto& switches = schedule.switches();
  std::vector<CueSwitches> out(cues);
  for (std::size_t k = 0; k < switches.size(); ++k) {
    if (!switches[k].cue) continue;
    CueSwitches& of = out[*switches[k].cue];
    if (of.end == 0) of.first = k - std::min<std::size_t>(k, 1);
    of.end = k + 1;
  }
  for (CueSwitches& of : out) {
    const std::size_t last = of.end;
    while (last > 0 && of.end < switches.size() && switches[of.end].time - switches[last - 1].time <= seconds(2))
      ++of.end;
  }
  return out;
}

void limit_flashes(const Plan& plan, const TempoMap& tempo, const CueSchedule& schedule, const Rig& rig,
                   std::vector<TempoLimit>& limits) {
  const auto cues = switches_of(schedule, limits.size());
  std::vector<LampStretch> stretches;
  for (std::size_t n = 0; n < rig.nodes.size(); ++n) {
    for (std::size_t c = 0; c < rig.nodes[n].channels.size(); ++c) {
      if (rig.nodes[n].channels[c].kind == Channel::Kind::unused) continue;
      for (std::size_t cue = 0; cue < cues.size(); ++cue) {
        stretches.clear();
        LookIndex shown = kNoGuidance;
        for (std::size_t k = cues[cue].first; k < cues[cue].end; ++k) {
          const LookIndex look = schedule.looks_of(k, NodeIndex::of(n))[c];
          if (look != shown) stretches.push_back({schedule.switches()[k].time, schedule.looks()[look]});
          shown = look;
        }
        TempoLimit& limit = limits[cue];
        if (stretches.size() < 3 || most_flashes(stretches, limit.percent) <= kMostFlashes) continue;
        const int flashes = most_flashes(stretches, limit.percent);
        const int before = limit.percent;
        while (limit.percent > 100 && most_flashes(stretches, limit.percent) > kMostFlashes) --limit.percent;
        limit.because =
            fmt::format("{} would light up {} times in a second at {} %, in the cue from count {:.4g}",
                        name_of(rig.nodes[n].channels[c], plan), flashes, before, tempo.count_at(stretches[0].from));
      }
    }
  }
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
  limit_flashes(plan, tempo, schedule, rig, limits);
  return limits;
}

}  // namespace footlight::controller
