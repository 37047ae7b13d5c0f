// SPDX-License-Identifier: Apache-2.0
// Painted sections among the models of motion.
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <fmt/format.h>

#include "planner/motion/models.hpp"
#include "planner/painted/painted_model.hpp"

namespace footlight::planner {
namespace {

constexpr double kArrived_m = 1;

/// Places are the scene's end cells, in whatever order.
std::vector<std::uint32_t> places_of(const MotionTask& task, const PaintedScene& scene, const PaintedModel& model) {
  const Grid& grid = scene.ways->grid();
  std::map<std::uint32_t, std::uint32_t> place;
  for (std::size_t k = 0; k < task.to.size(); ++k) {
    place[grid.nearest(task.to[k]).value()] = static_cast<std::uint32_t>(k);
  }
  const std::vector<CellIndex> ends = scene.end_cells();
  std::vector<std::uint32_t> out;
  for (const std::uint32_t number : model.place_of()) {
    const auto found = place.find(ends[number].value());
    FL_CHECK(found != place.end());
    out.push_back(found->second);
  }
  return out;
}

std::vector<std::size_t> by_cell(const MotionTask& task) {
  const Grid& grid = task.painting->ways->grid();
  std::vector<std::size_t> out(task.people());
  std::iota(out.begin(), out.end(), std::size_t{0});
  std::sort(out.begin(), out.end(),
            [&](std::size_t a, std::size_t b) { return grid.nearest(task.from[a]) < grid.nearest(task.from[b]); });
  return out;
}

}  // namespace

Result<Trajectory> move_crowd(const MotionTask& task, const PaintedOptions& options, const Progress& progress) {
  if (task.painting == nullptr) return internal_error("a painted section was moved without its painting");
  // In the order of their first cells: sums over neighbours do not depend on how people are numbered then.
  const std::vector<std::size_t> order = by_cell(task);
  MotionTask ordered = task;
  for (std::size_t n = 0; n < order.size(); ++n) {
    ordered.from[n] = task.from[order[n]];
    ordered.group[n] = task.group[order[n]];
    ordered.radius_m[n] = task.radius_m[order[n]];
    ordered.speed_mps[n] = task.speed_mps[order[n]];
  }
  const PaintedModel model(ordered, options, *task.painting);
  auto at = simulate(model, task.at_s, progress);
  if (!at) return Error{ErrorKind::interrupted, "planning was stopped"};
  Trajectory out;
  const auto numbered = [&](const auto& of) {
    auto back = of;
    for (std::size_t n = 0; n < order.size(); ++n) back[order[n]] = of[n];
    return back;
  };
  for (const std::vector<Point>& one : *at) out.at.push_back(numbered(one));
  if (!task.to.empty()) out.place_of = numbered(places_of(task, *task.painting, model));
  std::size_t late = 0;
  for (std::size_t i = 0; i < out.place_of.size(); ++i) {
    late += distance(out.at.back()[i], task.to[out.place_of[i]]) > kArrived_m ? 1 : 0;
  }
  if (late > 0) {
    out.notes.push_back(
        fmt::format("{} of {} people are still more than {:g} m from their places when the painting's "
                    "time is over: a longer duration gives them time",
                    late, task.people(), kArrived_m));
  }
  return out;
}

}  // namespace footlight::planner
