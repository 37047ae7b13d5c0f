// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/stops_over_cells.hpp"

#include <numeric>

namespace footlight::planner {
namespace {

/// Instants of so many steps, one more than steps: on the beats where they are enough, else evenly in the leg's time.
std::vector<Instant> times_of_steps(const Chain& chain, std::size_t leg, const Beats& beats, std::size_t steps) {
  std::vector<Instant> times = beats.at;
  if (steps < times.size()) {
    times.resize(steps + 1);
    return times;
  }
  const Instant depart = chain.stops[leg].depart;
  const double whole_s = to_seconds(chain.stops[leg + 1].arrive - depart);
  times.clear();
  for (std::size_t n = 0; n <= steps; ++n) times.push_back(depart + seconds(whole_s * double(n) / double(steps)));
  return times;
}

}  // namespace

Chain stops_over_cells(Chain chain, const std::vector<StepsOfLeg>& after, const std::vector<Beats>& beats,
                       const Show& show) {
  const double pitch_m = show.stage.grid.pitch_m();
  Chain whole;
  whole.stops.push_back(chain.stops.front());
  for (std::size_t leg = 0; leg < chain.legs.size(); ++leg) {
    const StepsOfLeg& steps = after[leg];
    const std::vector<Instant> times = times_of_steps(chain, leg, beats[leg], steps.size());
    if (!steps.empty()) whole.stops.back().depart = times.front();
    for (std::size_t n = 1; n < steps.size(); ++n) {
      Stop stop;
      stop.arrive = stop.depart = times[n];
      stop.count = show.tempo.count_at(times[n]);
      stop.section = chain.stops[leg + 1].section;
      stop.cells = steps[n - 1];
      whole.stops.push_back(std::move(stop));
      auto& target_of = whole.legs.emplace_back().target_of;
      target_of.resize(steps[n - 1].size());
      std::iota(target_of.begin(), target_of.end(), std::uint32_t{0});
      whole.longest_m.push_back(pitch_m);
    }
    whole.stops.push_back(chain.stops[leg + 1]);
    if (!steps.empty()) whole.stops.back().arrive = times.back();
    whole.legs.push_back(std::move(chain.legs[leg]));
    whole.longest_m.push_back(steps.empty() ? chain.longest_m[leg] : pitch_m);
  }
  return whole;
}

}  // namespace footlight::planner
