// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/raw_task.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "planner/motion/mark_instants.hpp"
#include "planner/motion/ordered_task.hpp"
#include "planner/plan_section.hpp"

namespace footlight::bench {

RawTask::RawTask(const Show& show, const Section& section)
    : ways(show.stage, show.stage.clearance_m / 2),
      floor(ways, section.motion->obstacles, show.tempo, show.tempo.at(section.start_count), show.terrain.get()) {}

std::unique_ptr<const RawTask> raw_task(const Show& show, const Plan& plan, const Section& section, double every_s) {
  auto out = std::make_unique<RawTask>(show, section);
  const Instant start = show.tempo.at(section.start_count);
  const Instant end = show.tempo.at(section.start_count + section.duration_counts);
  const auto stands = [&](std::size_t p, Instant at) { return position_at(show.stage.grid, plan.tracks[p], at); };
  out->performer.resize(plan.tracks.size());
  std::iota(out->performer.begin(), out->performer.end(), std::size_t{0});
  std::sort(out->performer.begin(), out->performer.end(), [&](std::size_t a, std::size_t b) {
    const Point left = stands(a, start);
    const Point right = stands(b, start);
    return std::pair(left.x, left.y) < std::pair(right.x, right.y);
  });
  const planner::MarkInstants marks = planner::mark_instants(
      {&show.tempo, &show.stage.grid, show.stage.walk, section.start_count, section.duration_counts,
       planner::section_speed(show, section), section.motion->mark_counts});
  planner::MotionTask task;
  for (const std::size_t p : out->performer) {
    task.from.push_back(stands(p, start));
    task.to.push_back(stands(p, end));
    const auto group = show.performers[p].group;
    task.group.push_back(group ? group->value() : planner::kNoGroup);
    task.radius_m.push_back(std::max(show.stage.clearance_m / 2, show.performers[p].radius_m));
    task.speed_mps.push_back(planner::kModelShare * marks.followed_mps);
    task.agility.push_back(show.performers[p].agility);
    task.reaction_s.push_back(show.performers[p].reaction_s);
  }
  if (!show.groups.empty()) task.to_group = task.group;
  const double duration_s = to_seconds(end - start);
  for (double at_s = 0; at_s < duration_s - 1e-9; at_s += every_s) task.at_s.push_back(at_s);
  task.at_s.push_back(duration_s);
  task.paths = section.motion->paths;
  task.floor = &out->floor;
  task.seed = section.motion->seed;
  out->task = planner::OrderedTask(task).task();
  return out;
}

std::vector<std::vector<Point>> walked_ways(const Show& show, const Plan& plan, const Section& section,
                                            const RawTask& raw) {
  const Instant start = show.tempo.at(section.start_count);
  std::vector<std::vector<Point>> out;
  for (const double at_s : raw.task.at_s) {
    auto& at = out.emplace_back();
    for (const std::size_t p : raw.performer) {
      at.push_back(position_at(show.stage.grid, plan.tracks[p], start + seconds(at_s)));
    }
  }
  return out;
}

}  // namespace footlight::bench
