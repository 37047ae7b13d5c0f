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
#include "planner/motion/ordered_task.hpp"
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
Result<Trajectory> run(const Landscape& landscape, const Model& model, Wanted wanted, const Progress& progress) {
  const MotionTask& task = landscape.task();
  Collisions collisions(task);
  auto at = simulate(model, task.at_s, progress, [&](const auto& now, const auto& next) {
    const double from_s = static_cast<double>(now.tick) * model.step_s();
    collisions.step(now.position, wanted(next), from_s, from_s + model.step_s());
  });
  if (!at) return Error{ErrorKind::interrupted, "planning was stopped"};
  Trajectory out;
  std::size_t late = 0;
  if (!task.to.empty()) {
    out.place_of = last_places(landscape, at->back());
    for (std::size_t p = 0; p < out.place_of.size(); ++p) {
      late += distance(at->back()[p], landscape.places()[out.place_of[p]]) > kArrived_m ? 1 : 0;
    }
  }
  out.at = std::move(*at);
  out.notes = landscape.notes();
  out.notes.push_back(note(landscape.options(), collisions, late));
  return out;
}

}  // namespace

Result<Trajectory> move_crowd(const MotionTask& task, const SwarmOptions& options, const Progress& progress) {
  const OrderedTask ordered(task);
  const auto landscape = Landscape::make(ordered.task(), options);
  if (!landscape) return landscape.error();
  const auto led = [&] {
    if (options.method == SwarmOptions::Method::original) {
      const auto wanted = [](const swarm::OriginalSwarm::State& next) { return std::span<const Point>(next.wanted); };
      return run(*landscape, swarm::OriginalSwarm(*landscape), wanted, progress);
    }
    const auto walked = [](const swarm::ProposedSwarm::State& next) { return std::span<const Point>(next.position); };
    return run(*landscape, swarm::ProposedSwarm(*landscape), walked, progress);
  }();
  if (!led) return led.error();
  return ordered.as_given(*led);
}

}  // namespace footlight::planner
