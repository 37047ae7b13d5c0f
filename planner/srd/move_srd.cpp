// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/format.h>

#include "planner/motion/models.hpp"
#include "planner/motion/ordered_task.hpp"
#include "planner/srd/srd_model.hpp"

namespace footlight::planner {
namespace {

/// Who ends farther than this from her place is told of.
constexpr double kLate_m = 1;

}  // namespace

Result<Trajectory> move_crowd(const MotionTask& task, const SrdOptions& options, const Progress& progress) {
  const OrderedTask ordered(task);
  auto model = srd::SrdModel::make(ordered.task(), options);
  if (!model) return model.error();
  auto at = simulate(*model, task.at_s, progress);
  if (!at) return Error{ErrorKind::interrupted, "stopped while people were led"};
  Trajectory out{std::move(*at), model->place_of(), {}};
  const std::vector<Point> places = model->destinations(task.duration_s());
  const auto late = std::count_if(places.begin(), places.end(), [&, i = std::size_t{0}](Point place) mutable {
    return distance(out.at.back()[i++], place) > kLate_m;
  });
  if (late > 0) {
    out.notes.push_back(fmt::format("{} of {} people are more than {:g} m from their places when the section ends",
                                    late, task.people(), kLate_m));
  }
  return ordered.as_given(out);
}

}  // namespace footlight::planner
