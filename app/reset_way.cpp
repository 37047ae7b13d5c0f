// SPDX-License-Identifier: Apache-2.0
#include "app/reset_way.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "controller/stands.hpp"
#include "planner/plan_show.hpp"

namespace footlight::app {
namespace {

constexpr double kLeastWalk_counts = 4;

const PlanSection& section_at(const Plan& plan, Instant at) {
  const auto found = std::ranges::find_if(plan.sections, [&](const PlanSection& section) { return section.end >= at; });
  return found == plan.sections.end() ? plan.sections.back() : *found;
}

Section stand(const char* name, std::vector<CellIndex> cells, double start_count) {
  Section section;
  section.name = name;
  CellsSource source;
  source.path = name;
  source.cells = std::move(cells);
  section.from = std::move(source);
  section.start_count = start_count;
  return section;
}

double longest_walk_s(const Show& show, const Plan& plan, const std::vector<CellIndex>& from,
                      const std::vector<CellIndex>& to, double speed_mps) {
  double longest_s = 0;
  for (std::size_t p = 0; p < from.size(); ++p) {
    const double walk_m = distance(show.stage.grid.centre(from[p]), show.stage.grid.centre(to[p]));
    const double own_mps = plan.max_speed_mps[p] > 0 ? std::min(plan.max_speed_mps[p], speed_mps) : speed_mps;
    longest_s = std::max(longest_s, walk_m / own_mps);
  }
  return longest_s;
}

/// @param here, there of which the limits hold
Result<Plan> way_between(const Show& show, const Plan& plan, const std::vector<CellIndex>& cells,
                         const std::vector<CellIndex>& goals, const PlanSection& here, const PlanSection& there,
                         double bpm, double count_in_counts, const std::atomic<bool>& abandoned) {
  const auto limit = [&](const PlanSection& section) {
    return section.max_speed_mps > 0 ? section.max_speed_mps : show.stage.max_speed_mps;
  };
  const double speed_mps = std::min(limit(here), limit(there));

  Show way = show;
  way.cues.clear();
  way.tempo = TempoMap(bpm, show.tempo.beats_per_measure());
  // Whoever stands in for somebody does so already.
  for (Performer& performer : way.performers) performer.absent = false;
  const double counts = longest_walk_s(show, plan, cells, goals, speed_mps) * bpm / 60;
  planner::Progress progress;
  progress.stop = &abandoned;
  std::string why;
  for (const double slack : std::array{1.0, 1.25, 1.6, 2.0, 3.0, 4.0}) {
    const double walk = std::max(kLeastWalk_counts, std::ceil(counts * slack));
    way.sections = {stand("start", cells, 1), stand("places", goals, 1 + count_in_counts + walk)};
    way.sections[0].hold_counts = count_in_counts;
    for (Section& section : way.sections) section.max_speed_mps = speed_mps;
    auto planned = planner::plan_show(way, {std::nullopt, std::nullopt}, progress);
    if (!planned) return std::move(planned).error();
    if (planned->plan.valid) {
      Plan found = std::move(planned->plan);
      found.sections[0].reserve = here.reserve;
      found.sections[1].reserve = there.reserve;
      return found;
    }
    if (!planned->refusal.empty()) why = planned->refusal.front();
  }
  // The place of the message is a show that nobody wrote.
  const std::size_t text = why.find(": error: ");
  return refusal(text == std::string::npos ? why : why.substr(text + 9));
}

double bpm_at(const Show& show, Instant at) { return show.tempo.bpm_at(show.tempo.count_at(at)); }

}  // namespace

Result<Plan> plan_reset_way(const Show& show, const Plan& plan, Instant from, Instant to, double count_in_counts,
                            const std::atomic<bool>& abandoned) {
  return way_between(show, plan, controller::cells_at(plan, from), controller::cells_at(plan, to),
                     section_at(plan, from), section_at(plan, to), bpm_at(show, from), count_in_counts, abandoned);
}

Result<Plan> plan_way(const Show& show, const Plan& plan, const std::vector<CellIndex>& cells, Instant to,
                      double count_in_counts, const std::atomic<bool>& abandoned) {
  const PlanSection& there = section_at(plan, to);
  return way_between(show, plan, cells, controller::cells_at(plan, to), there, there, bpm_at(show, to), count_in_counts,
                     abandoned);
}

}  // namespace footlight::app
