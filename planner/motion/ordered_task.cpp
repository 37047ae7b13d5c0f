// SPDX-License-Identifier: Apache-2.0
#include "planner/motion/ordered_task.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace footlight::planner {
namespace {

std::vector<std::uint32_t> order_of(const std::vector<Point>& points) {
  std::vector<std::uint32_t> out(points.size());
  std::iota(out.begin(), out.end(), 0U);
  std::sort(out.begin(), out.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::tuple(points[a].x, points[a].y, a) < std::tuple(points[b].x, points[b].y, b);
  });
  return out;
}

template <class T>
std::vector<T> chosen(const std::vector<T>& all, const std::vector<std::uint32_t>& which) {
  std::vector<T> out;
  if (all.empty()) return out;
  out.reserve(which.size());
  for (const std::uint32_t i : which) out.push_back(all[i]);
  return out;
}

template <class T>
std::vector<T> put_back(const std::vector<T>& ordered, const std::vector<std::uint32_t>& which) {
  std::vector<T> out(ordered.size());
  for (std::size_t i = 0; i < ordered.size(); ++i) out[which[i]] = ordered[i];
  return out;
}

}  // namespace

OrderedTask::OrderedTask(const MotionTask& given)
    : task_(given), who_(order_of(given.from)), where_(order_of(given.to)) {
  task_.from = chosen(given.from, who_);
  task_.group = chosen(given.group, who_);
  task_.radius_m = chosen(given.radius_m, who_);
  task_.speed_mps = chosen(given.speed_mps, who_);
  task_.agility = chosen(given.agility, who_);
  task_.reaction_s = chosen(given.reaction_s, who_);
  task_.to = chosen(given.to, where_);
  task_.to_group = chosen(given.to_group, where_);
}

Trajectory OrderedTask::as_given(const Trajectory& led) const {
  Trajectory out;
  for (const auto& at : led.at) out.at.push_back(put_back(at, who_));
  out.notes = led.notes;
  if (led.place_of.empty()) return out;
  std::vector<std::uint32_t> place_of;
  for (const std::uint32_t place : led.place_of) place_of.push_back(where_[place]);
  out.place_of = put_back(place_of, who_);
  return out;
}

}  // namespace footlight::planner
