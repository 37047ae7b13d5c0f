// SPDX-License-Identifier: Apache-2.0
// Painted sections among the models of motion.
#include <algorithm>
#include <cmath>
#include <map>

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

}  // namespace

Result<Trajectory> move_crowd(const MotionTask& task, const PaintedOptions& options, const Progress& progress) {
  if (task.painting == nullptr) return internal_error("a painted section was moved without its painting");
  const PaintedModel model(task, options, *task.painting);
  auto at = simulate(model, task.at_s, progress);
  if (!at) return Error{ErrorKind::interrupted, "planning was stopped"};
  Trajectory out;
  out.at = std::move(*at);
  if (!task.to.empty()) out.place_of = places_of(task, *task.painting, model);
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
