// SPDX-License-Identifier: Apache-2.0
#include "planner/joint_section.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "planner/assignment/assignment.hpp"
#include "planner/formation/cell_shares.hpp"
#include "planner/parallel.hpp"
#include "planner/schedule/walks.hpp"

namespace footlight::planner {
namespace {

/// Share of the longest walk that is counted on where blocked cells may be in the way.
constexpr double kAroundBlocked = 0.7;
constexpr double kRounding_m = 1e-9;

/// The film with the time before it, from where people stand then. Who cannot be in the first formation in time and
/// clear of the others comes later.
std::optional<JointPlan> plan_from_before(const JointSection& section, Station& first, const Progress& progress) {
  JointTask task = section.task;
  const Station& before = *section.before;
  const Grid& grid = task.ways->grid();
  const Duration gap = task.start - before.depart;
  const double walk_s = kJointInterval * grid.pitch_m() / task.speed_mps;
  const auto room = static_cast<int>(kMostNodes / static_cast<std::size_t>(grid.size()) - task.instants.size());
  const int steps = std::clamp(static_cast<int>(to_seconds(gap) / walk_s), 1, std::max(1, room));
  std::vector<KeyFrame> instants;
  for (int step = 0; step < steps; ++step) {
    instants.push_back({0, 0, before.depart + seconds(to_seconds(gap) * step / steps)});
  }
  task.instants.insert(task.instants.begin(), instants.begin(), instants.end());
  if (!task.given.empty()) task.given.insert(task.given.begin(), instants.size(), {});
  task.first = before.cells;
  auto joint = plan_jointly(task, progress);
  if (!joint) return std::nullopt;
  joint->at.erase(joint->at.begin(), joint->at.begin() + steps);
  const double longest_m = task.speed_mps * to_seconds(gap) - kRounding_m;
  const Leg leg = settle({task.ways, before.cells, joint->at[0], longest_m, section.show->stage.clearance_m});
  first.exact = leg.walkable && leg.conflicts.empty();
  first.follows = true;
  return joint;
}

/// Whether the cells of each of the director's key formations are taken.
bool keeps_keys(const JointTask& task, const std::vector<Station>& stations,
                const std::vector<std::vector<CellIndex>>& at) {
  for (std::size_t n = 0; n < stations.size(); ++n) {
    if (!task.instants[n].given) continue;
    std::vector<CellIndex> wanted = stations[n].cells;
    std::vector<CellIndex> taken = at[n];
    std::sort(wanted.begin(), wanted.end());
    std::sort(taken.begin(), taken.end());
    if (wanted != taken) return false;
  }
  return true;
}

void take(const JointTask& task, JointPlan joint, SectionPlan& plan, const Progress& progress) {
  for_each_index(plan.stations.size(), "formations", progress, [&](std::size_t n) {
    Station& station = plan.stations[n];
    station.cells = std::move(joint.at[n]);
    station.follows = n > 0 || station.follows;
    const Mask& picture = task.film->frames[static_cast<std::size_t>(task.instants[n].frame)];
    const auto shares = cell_shares(picture, task.ways->grid(), task.map);
    station.in_picture =
        static_cast<int>(std::count_if(station.cells.begin(), station.cells.end(), [&](CellIndex cell) {
          return (*task.usable)[cell.at()] != 0 && shares[cell.at()] > 0;
        }));
  });
  plan.section.notes.push_back(
      fmt::format("drawing and walks are planned together: nobody who keeps the speed limit could save more than "
                  "{:.2g} intervals outside of the picture a person",
                  joint.gap / static_cast<double>(task.people)));
}

}  // namespace

std::string draw_and_walk(JointSection section, SectionPlan& plan, const Progress& progress) {
  JointTask& task = section.task;
  const auto& keys = task.instants;
  if (std::any_of(keys.begin(), keys.end(), [](const KeyFrame& key) { return key.given; })) {
    task.given.resize(keys.size());
    for (std::size_t n = 0; n < keys.size(); ++n) {
      if (keys[n].given) task.given[n] = plan.stations[n].cells;
    }
  }
  const Station* before = section.before;
  const bool no_gap = before != nullptr && task.start <= before->depart;
  if (no_gap) task.first = before->cells;  // no time to go anywhere else
  auto joint = plan_jointly(task, progress);
  plan.begin = no_gap ? Begin::from_before : Begin::where_best;
  if (joint && before != nullptr && !no_gap) {
    Station first = plan.stations.front();
    first.cells = joint->at[0];
    if (!can_begin(*section.show, section.index, *task.ways, *before, first)) {
      plan.begin = Begin::from_before;
      joint = plan_from_before(section, plan.stations.front(), progress);
    }
  }
  if (!joint) return {};
  if (!keeps_keys(task, plan.stations, joint->at)) return "the formations of its keys cannot all be reached in time";
  take(task, std::move(*joint), plan, progress);
  return {};
}

bool can_begin(const Show& show, SectionIndex section, const Ways& ways, const Station& before, const Station& first) {
  const double time_s = to_seconds(first.arrive - before.depart);
  const double longest_m = section_speed(show, show.sections[section.at()]) * time_s - kRounding_m;
  if (longest_m <= 0) return false;
  const Grid& grid = show.stage.grid;
  std::vector<Point> sources;
  std::vector<Point> targets;
  for (const CellIndex cell : before.cells) sources.push_back(grid.centre(cell));
  for (const CellIndex cell : first.cells) targets.push_back(grid.centre(cell));
  if (!ways.open()) return assign(sources, targets, WalkCost::squared, kAroundBlocked * longest_m).has_value();
  // The least squares keep people clear of each other; where a limit forbids them that is not worth trying.
  const auto best = assign(sources, targets, WalkCost::squared, std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; best && i < sources.size(); ++i) {
    if (distance(sources[i], targets[best->target_of[i]]) > longest_m) return false;
  }
  if (show.stage.clearance_m <= grid.clearance_bound_m()) return true;
  const Leg leg = settle({&ways, before.cells, first.cells, longest_m, show.stage.clearance_m});
  return leg.walkable && leg.conflicts.empty();
}

}  // namespace footlight::planner
