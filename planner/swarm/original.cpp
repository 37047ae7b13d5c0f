// SPDX-License-Identifier: Apache-2.0
#include "planner/swarm/original.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/rng.hpp"
#include "planner/swarm/equations.hpp"
#include "planner/swarm/surroundings.hpp"

namespace footlight::planner::swarm {

OriginalSwarm::OriginalSwarm(const Landscape& landscape)
    : landscape_(&landscape), knows_target_(landscape.options().best == SwarmOptions::Best::target) {}

OriginalSwarm::State OriginalSwarm::begin() const {
  const MotionTask& task = landscape_->task();
  State out;
  out.position = out.wanted = out.best = task.from;
  for (std::size_t p = 0; p < task.people(); ++p) {
    Rng rng = Rng(task.seed).split(p);
    const double angle = 2 * std::numbers::pi * rng.uniform();
    const double speed_mps = task.speed_mps[p] * landscape_->speed_factor(task.from[p]) * rng.uniform();
    out.velocity.push_back({speed_mps * std::cos(angle), speed_mps * std::sin(angle)});
    out.best_weighed.push_back(weighed_cost(p, task.from[p], 0));
  }
  out.crowd_best = CrowdBest(landscape_->crowds());
  out.crowd_best.improve(*landscape_, out.best, out.best_weighed, landscape_->first_places(), landscape_->shifts(0));
  return out;
}

double OriginalSwarm::weighed_cost(std::size_t person, Point at, double at_s) const {
  double squared = landscape_->still_squared(at, std::numeric_limits<double>::infinity());
  for (const MotionFloor::Disc& disc : landscape_->task().floor->discs(at_s)) {
    const double both_m = disc.radius_m + landscape_->scope_m(person);
    squared = std::min(squared, squared_length(at - disc.centre) / (both_m * both_m));
  }
  return landscape_->options().avoid * object_cost(squared);
}

void OriginalSwarm::step_one(const State& now, State& next, std::size_t p, Point target) const {
  const MotionTask& task = landscape_->task();
  const SwarmOptions& options = landscape_->options();
  Rng rng = Rng(task.seed).split(p).split(now.tick + 1);
  const double r1 = rng.uniform();
  const double r2 = rng.uniform();
  const Pull pull{options.inertia, options.cognitive * r1, options.social * r2};
  const Point crowd_best = knows_target_ ? target : target + now.crowd_best.offset[landscape_->crowd(p)];
  const Point at = now.position[p];
  Point move = next_velocity(step_s() * now.velocity[p], at, now.best[p], crowd_best, pull);
  const double most_m = task.speed_mps[p] * landscape_->speed_factor(at) * step_s();
  const double move_m = length(move);
  if (move_m > most_m) move = most_m / move_m * move;
  next.velocity[p] = 1 / step_s() * move;
  next.wanted[p] = at + move;
  const double share = task.floor->free_share(at, next.wanted[p]);
  next.position[p] = share >= 1 ? next.wanted[p] : at + share * move;
  if (share < 1) next.velocity[p] = -1 * next.velocity[p];
}

void OriginalSwarm::step(const State& now, State& next) const {
  const double from_s = static_cast<double>(now.tick) * step_s();
  const auto shifts = landscape_->shifts(from_s + step_s());
  const auto& places = landscape_->first_places();
  for_people(now.position.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t p = first; p < last; ++p) {
      const Point target = landscape_->target(places[p], shifts[landscape_->crowd(p)]);
      step_one(now, next, p, target);
      const double weighed = weighed_cost(p, next.position[p], from_s + step_s());
      const double best = landscape_->value(now.best_weighed[p], distance(now.best[p], target));
      if (landscape_->value(weighed, distance(next.position[p], target)) > best) continue;
      next.best[p] = next.position[p];
      next.best_weighed[p] = weighed;
    }
  });
  next.crowd_best.improve(*landscape_, next.best, next.best_weighed, places, shifts);
}

}  // namespace footlight::planner::swarm
