// SPDX-License-Identifier: Apache-2.0
#include "planner/swarm/proposed.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include <tbb/parallel_invoke.h>

#include "planner/repair/closest_approach.hpp"
#include "planner/swarm/equations.hpp"

namespace footlight::planner::swarm {
namespace {

constexpr double kRounding_m = 1e-9;
/// So often somebody looks whether the way around what is blocked has changed.
constexpr double kLook_s = 0.6;
/// Places are exchanged when that lowers the sum of squared ways by this much; a falling sum comes to an end.
constexpr double kGain_m2 = 0.01;
/// c_obj of who is in the way of something that moves: the target hardly counts.
constexpr double kFleeing = 100;
constexpr double kFar = std::numeric_limits<double>::infinity();

/// Two people who are too near already may go on where they do not come nearer.
double least_m(double room_m, double now_m) { return std::min(room_m, now_m) - kRounding_m; }

}  // namespace

ProposedSwarm::ProposedSwarm(const Landscape& landscape)
    : landscape_(&landscape),
      knows_target_(landscape.options().best == SwarmOptions::Best::target),
      look_ticks_(std::max<std::uint64_t>(1, static_cast<std::uint64_t>(kLook_s / landscape.options().step_s))) {
  for (std::size_t p = 0; p < landscape.people(); ++p) {
    pace_.push_back(1 - landscape.options().pace_spread * Rng(landscape.task().seed).split(p).uniform());
  }
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> number;
  for (std::size_t p = 0; p < landscape.people(); ++p) {
    const std::pair both{landscape.exchange_class(p), landscape.crowd(p)};
    may_trade_.push_back(number.try_emplace(both, static_cast<std::uint32_t>(number.size())).first->second);
  }
  for (int n = 1; n <= landscape.options().grid_steps; ++n) {
    for (const int side : {-1, 1}) {
      const double angle_rad = side * n * landscape.options().grid_angle_rad;
      grid_turns_.emplace_back(std::cos(angle_rad), std::sin(angle_rad));
    }
  }
}

ProposedSwarm::State ProposedSwarm::begin() const {
  const MotionTask& task = landscape_->task();
  State out;
  out.position = out.best = task.from;
  out.velocity.resize(task.people());
  out.best_weighed.assign(task.people(), 1);
  out.place = landscape_->first_places();
  out.rest_m.resize(task.people());
  out.heading_for.resize(task.people());
  out.direction.resize(task.people());
  out.crowd_best = CrowdBest(landscape_->crowds());
  const auto shifts = landscape_->shifts(0);
  for_people(task.people(), [&](std::size_t first, std::size_t last) {
    for (std::size_t p = first; p < last; ++p) {
      const Point target = landscape_->target(out.place[p], shifts[landscape_->crowd(p)]);
      const auto way = landscape_->toward(p, task.from[p], target, 0);
      out.heading_for[p] = way.at;
      out.rest_m[p] = way.rest_m;
      out.direction[p] = unit(way.at - task.from[p]);
      if (out.direction[p] != Point{}) continue;  // she is there already
      const double angle = 2 * std::numbers::pi * Rng(task.seed).split(p).uniform();
      out.direction[p] = {std::cos(angle), std::sin(angle)};
    }
  });
  if (!knows_target_) out.crowd_best.improve(*landscape_, out.best, out.best_weighed, out.place, shifts);
  return out;
}

void ProposedSwarm::step(const State& now, State& next) const {
  const double from_s = static_cast<double>(now.tick) * step_s();
  const auto shifts = landscape_->shifts(from_s + step_s());
  const auto lent = scratch_.take();
  Scratch& scratch = *lent;
  tbb::parallel_invoke([&] { scratch.around.sort(*landscape_, now.position, from_s, from_s + step_s()); },
                       [&] { find_ways(now, shifts, from_s, next); });
  const Turn turn{now, next, scratch, shifts, from_s};
  find_targets(turn);
  scratch.wishes.resize(now.position.size());
  for_people(scratch.wishes.size(), [&](std::size_t first, std::size_t last) {
    std::vector<Surroundings::Near> near;
    for (std::size_t k = first; k < last; ++k) scratch.wishes[k] = choose(turn, k, near);
  });
  settle(turn, next);
  if (!knows_target_) next.crowd_best.improve(*landscape_, next.best, next.best_weighed, next.place, shifts);
}

double ProposedSwarm::avoid(Point at, Point heading_for, double rest_m) const {
  const SwarmOptions& options = landscape_->options();
  const double share = rest_m > 0 ? 1 : std::min(1.0, distance(at, heading_for) / options.slow_m);
  return options.avoid * share * share;
}

void ProposedSwarm::find_ways(const State& now, std::span<const Point> shifts, double from_s, State& next) const {
  for_people(now.position.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t p = first; p < last; ++p) {
      const Point target = landscape_->target(now.place[p], shifts[landscape_->crowd(p)]);
      const double reached_m = landscape_->task().speed_mps[p] * step_s();
      const bool corner = now.rest_m[p] > 0 && distance(now.position[p], now.heading_for[p]) < reached_m;
      WayField::Toward way{target, 0};
      if (landscape_->has_ways() && !corner && (now.tick + p) % look_ticks_ != 0) {
        if (now.rest_m[p] > 0) way = {now.heading_for[p], now.rest_m[p]};
      } else if (landscape_->has_ways()) {
        way = landscape_->toward(p, now.position[p], target, from_s);
      }
      // What was best on the last piece of the way means nothing on the next.
      if (way.rest_m != now.rest_m[p]) next.best[p] = now.position[p];
      next.heading_for[p] = way.at;
      next.rest_m[p] = way.rest_m;
    }
  });
}

void ProposedSwarm::find_targets(const Turn& turn) const {
  Scratch& scratch = turn.scratch;
  const auto order = scratch.around.order();
  scratch.target.resize(order.size());
  scratch.may_trade.resize(order.size());
  for_people(order.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      const std::size_t p = order[k];
      scratch.target[k] = landscape_->target(turn.now.place[p], turn.shifts[landscape_->crowd(p)]);
      scratch.may_trade[k] = turn.now.rest_m[p] > 0 ? kNobody : may_trade_[p];
    }
  });
}

ProposedSwarm::Walker ProposedSwarm::walker_of(const Turn& turn, std::size_t rank,
                                               std::span<const Surroundings::Near> near) const {
  const std::size_t p = turn.scratch.around.order()[rank];
  Walker out{p, rank, turn.now.position[p], turn.next.heading_for[p], turn.next.rest_m[p], near};
  out.avoid = avoid(out.at, out.heading_for, out.rest_m);
  out.open = landscape_->open_around(out.at);
  out.still_squared = out.open ? kFar : landscape_->still_squared(out.at, kFar);
  for (const auto& one : near) {
    out.still_squared = std::min(out.still_squared, squared_length(one.away) * one.per_scope_square);
  }
  return out;
}

ProposedSwarm::Intention ProposedSwarm::choose(const Turn& turn, std::size_t rank,
                                               std::vector<Surroundings::Near>& near) const {
  const SwarmOptions& options = landscape_->options();
  const MotionTask& task = landscape_->task();
  const Surroundings& around = turn.scratch.around;
  const State& now = turn.now;
  const std::size_t p = around.order()[rank];
  around.look(rank, near);
  Walker walker = walker_of(turn, rank, near);
  const double ground = landscape_->ground_cost(walker.at);
  const double objects = object_cost(around.disc_squared(p, walker.at, walker.still_squared));
  const double stay_weighed = std::max(walker.avoid * objects, options.avoid * ground);
  Rng rng = Rng(task.seed).split(p).split(now.tick + 1);
  Intention out{walker.at, walker.at, now.direction[p], stay_weighed, rng.uniform(), better_place(turn, walker)};
  const double r1 = rng.uniform();
  const double r2 = rng.uniform();
  const bool flees = around.threatens(p, walker.at);
  if (flees) {
    out.priority += 1;  // others wait for her
    walker.avoid = kFleeing;
  }

  const Point crowd_best = knows_target_ || walker.rest_m > 0
                               ? walker.heading_for
                               : walker.heading_for + now.crowd_best.offset[landscape_->crowd(p)];
  const Pull pull{options.inertia, options.cognitive * r1, options.social * r2};
  out.direction = next_direction(now.direction[p], walker.at, turn.next.best[p], crowd_best, pull);
  const double to_target_m = distance(walker.at, walker.heading_for);
  const double fastest_m = task.speed_mps[p] * pace_[p] * landscape_->speed_factor(walker.at) * step_s();
  const double share =
      speed_share(objects, options.hardness, walker.rest_m > 0 ? options.slow_m : to_target_m, options.slow_m);
  const double step_m = flees ? fastest_m : std::min(fastest_m * share, to_target_m);
  if (step_m < kRounding_m) return out;

  const Point move = step_m * out.direction;
  Tries straight;
  straight.add(move);
  Option taken = best_of(turn, walker, straight);
  if (flees || !taken.free() || rng.uniform() >= acceptance(taken.worst, options.hardness)) {
    taken = search(turn, walker, move, flees, rng);
  }
  if (!taken.allowed) return out;
  if (!taken.free()) {  // too near to something that moves: better than to stay, at least
    double stay_m = kFar;
    for (const Surroundings::Disc& disc : around.discs()) stay_m = std::min(stay_m, disc_room(disc, walker, walker.at));
    if (taken.disc_m <= stay_m) return out;
  }
  out.to = walker.at + taken.step;
  out.weighed = taken.weighed;
  out.direction = unit(taken.step);
  return out;
}

std::uint32_t ProposedSwarm::better_place(const Turn& turn, const Walker& walker) const {
  const Scratch& scratch = turn.scratch;
  const auto own = static_cast<std::uint32_t>(walker.rank);
  std::uint32_t best = own;
  const std::uint32_t with = scratch.may_trade[own];
  if (walker.rest_m > 0 || with == kNobody) return best;
  const auto order = scratch.around.order();
  double gain = kGain_m2;
  for (const Surroundings::Near& one : walker.near) {
    if (scratch.may_trade[one.rank] != with) continue;
    // |p - a|^2 + |q - b|^2 - |p - b|^2 - |q - a|^2
    const double less = -2 * dot(one.away, scratch.target[one.rank] - scratch.target[own]);
    if (less <= gain && !(less == gain && best != own && order[one.rank] < order[best])) continue;
    gain = less;
    best = one.rank;
  }
  return best;
}

bool ProposedSwarm::has_to_wait(const Turn& turn, std::size_t rank) const {
  const Surroundings& around = turn.scratch.around;
  const std::vector<Intention>& wishes = turn.scratch.wishes;
  const auto order = around.order();
  const Intention& own = wishes[rank];
  const double own_m = distance(own.from, own.to);
  bool waits = false;
  around.visit_touching(rank, [&](std::uint32_t k) {
    const Intention& other = wishes[k];
    if (waits || other.to == other.from) return;
    if (std::pair(own.priority, order[rank]) > std::pair(other.priority, order[k])) return;
    const double room_m = around.radius_m(rank) + around.radius_m(k);
    const double reach_m = room_m + own_m + distance(other.from, other.to);
    const double now_square = squared_length(own.from - other.from);
    if (now_square > reach_m * reach_m) return;
    waits = closest_approach({own.from, own.to}, {other.from, other.to}).distance_m <
            least_m(room_m, std::sqrt(now_square));
  });
  return waits;
}

void ProposedSwarm::settle(const Turn& turn, State& next) const {
  const State& now = turn.now;
  const std::vector<Intention>& wishes = turn.scratch.wishes;
  const auto order = turn.scratch.around.order();
  for_people(wishes.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      const std::size_t p = order[k];
      const Intention& wish = wishes[k];
      next.direction[p] = wish.direction;
      const bool goes = wish.to != wish.from && !has_to_wait(turn, k);
      if (goes) next.position[p] = wish.to;
      next.velocity[p] = 1 / step_s() * (next.position[p] - wish.from);
      if (wish.exchange != k && wishes[wish.exchange].exchange == k) {
        next.place[p] = now.place[order[wish.exchange]];
        next.best[p] = next.position[p];
        next.best_weighed[p] = wish.weighed;
        continue;
      }
      const auto value = [&](double weighed, Point at) {
        return landscape_->value(weighed, distance(at, next.heading_for[p]) + next.rest_m[p]);
      };
      if (!goes || value(wish.weighed, wish.to) > value(now.best_weighed[p], next.best[p])) continue;
      next.best[p] = wish.to;
      next.best_weighed[p] = wish.weighed;
    }
  });
}

}  // namespace footlight::planner::swarm
