// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/motion/swarm_options.hpp"
#include "planner/assignment/assignment.hpp"
#include "planner/motion/models.hpp"
#include "planner/swarm/collisions.hpp"
#include "planner/swarm/landscape.hpp"
#include "planner/swarm/original.hpp"
#include "planner/swarm/proposed.hpp"

namespace footlight::planner {
namespace {

using swarm::Collisions;
using swarm::Landscape;

/// Farther than this from the own place nobody has arrived.
constexpr double kArrived_m = 0.5;

/// The same task with people and places in the order of where they are, so that whatever order they came in has no
/// influence, not even on who wins among equals.
struct Ordered {
  MotionTask task;
  std::vector<std::uint32_t> who;    ///< of each person of `task`, her number in the task as it came
  std::vector<std::uint32_t> where;  ///< of each place

  explicit Ordered(const MotionTask& given) : task(given), who(order_of(given.from)), where(order_of(given.to)) {
    for (std::size_t i = 0; i < who.size(); ++i) {
      task.from[i] = given.from[who[i]];
      task.group[i] = given.group[who[i]];
      task.radius_m[i] = given.radius_m[who[i]];
      task.speed_mps[i] = given.speed_mps[who[i]];
    }
    for (std::size_t i = 0; i < where.size(); ++i) {
      task.to[i] = given.to[where[i]];
      if (!given.to_group.empty()) task.to_group[i] = given.to_group[where[i]];
    }
  }
  static std::vector<std::uint32_t> order_of(const std::vector<Point>& points) {
    std::vector<std::uint32_t> out(points.size());
    std::iota(out.begin(), out.end(), 0U);
    std::sort(out.begin(), out.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::pair(points[a].x, points[a].y) < std::pair(points[b].x, points[b].y);
    });
    return out;
  }
  /// A list by the ordered people, as they came.
  template <class T>
  [[nodiscard]] std::vector<T> as_given(const std::vector<T>& list) const {
    std::vector<T> out(list.size());
    for (std::size_t i = 0; i < list.size(); ++i) out[who[i]] = list[i];
    return out;
  }
};

/// Who takes which place from where she has come to: within a class the least sum of squares.
std::vector<std::uint32_t> last_places(const Landscape& landscape, const std::vector<Point>& at) {
  std::vector<std::uint32_t> out = landscape.first_places();
  std::vector<std::vector<std::uint32_t>> classes;
  for (std::uint32_t p = 0; p < out.size(); ++p) {
    classes.resize(std::max<std::size_t>(classes.size(), landscape.exchange_class(p) + 1));
    classes[landscape.exchange_class(p)].push_back(p);
  }
  for (const auto& people : classes) {
    std::vector<Point> from;
    std::vector<Point> to;
    std::vector<std::uint32_t> place;
    for (const std::uint32_t p : people) {
      from.push_back(at[p]);
      place.push_back(landscape.first_places()[p]);
      to.push_back(landscape.places()[place.back()]);
    }
    const auto pairing = assign(from, to, WalkCost::squared, std::numeric_limits<double>::infinity());
    if (!pairing) continue;
    for (std::size_t i = 0; i < people.size(); ++i) out[people[i]] = place[pairing->target_of[i]];
  }
  return out;
}

std::string method_name(const SwarmOptions& options) {
  return options.method == SwarmOptions::Method::original ? "the original swarm" : "the swarm";
}

/// What people are told: collisions of the trajectory itself, and who is still on the way.
std::string note(const SwarmOptions& options, const Collisions& collisions, std::size_t late) {
  std::string out = fmt::format("{} has {} collision{} between people and {} with obstacles on its way",
                                method_name(options), collisions.between_people(),
                                collisions.between_people() == 1 ? "" : "s", collisions.with_obstacles());
  if (late > 0) {
    out += fmt::format("; at its end {} {} more than {:g} m from a place", late, late == 1 ? "is" : "are", kArrived_m);
  }
  return out;
}

template <class Model, class Wanted>
Result<Trajectory> run(const Ordered& ordered, const Landscape& landscape, const Model& model, Wanted wanted,
                       const Progress& progress) {
  const MotionTask& task = ordered.task;
  Collisions collisions(task);
  auto at = simulate(model, task.at_s, progress, [&](const auto& now, const auto& next) {
    const double from_s = static_cast<double>(now.tick) * model.step_s();
    collisions.step(now.position, wanted(next), from_s, from_s + model.step_s());
  });
  if (!at) return Error{ErrorKind::interrupted, "planning was stopped"};
  Trajectory out;
  std::size_t late = 0;
  if (!task.to.empty()) {
    const auto places = last_places(landscape, at->back());
    std::vector<std::uint32_t> given(places.size());
    for (std::size_t p = 0; p < places.size(); ++p) {
      given[p] = ordered.where[places[p]];
      late += distance(at->back()[p], landscape.places()[places[p]]) > kArrived_m ? 1 : 0;
    }
    out.place_of = ordered.as_given(given);
  }
  for (const auto& instant : *at) out.at.push_back(ordered.as_given(instant));
  out.notes = landscape.notes();
  out.notes.push_back(note(landscape.options(), collisions, late));
  return out;
}

}  // namespace

Result<Trajectory> move_crowd(const MotionTask& task, const SwarmOptions& options, const Progress& progress) {
  const Ordered ordered(task);
  const auto landscape = Landscape::make(ordered.task, options);
  if (!landscape) return landscape.error();
  if (options.method == SwarmOptions::Method::original) {
    const auto wanted = [](const swarm::OriginalSwarm::State& next) { return std::span<const Point>(next.wanted); };
    return run(ordered, *landscape, swarm::OriginalSwarm(*landscape), wanted, progress);
  }
  const auto walked = [](const swarm::ProposedSwarm::State& next) { return std::span<const Point>(next.position); };
  return run(ordered, *landscape, swarm::ProposedSwarm(*landscape), walked, progress);
}

}  // namespace footlight::planner
