// SPDX-License-Identifier: Apache-2.0
#include "planner/swarm/proposed.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

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

Point turned(Point v, double angle_rad) {
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  return {c * v.x - s * v.y, s * v.x + c * v.y};
}

double squared_to_segment(Point p, Point a, Point b) {
  const Point along = b - a;
  const double square = squared_length(along);
  const double share = square > 0 ? std::clamp(dot(p - a, along) / square, 0.0, 1.0) : 0.0;
  return squared_length(p - a - share * along);
}

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
  const Surroundings around(*landscape_, now.position, from_s, from_s + step_s());
  const Turn turn{now, around, shifts, from_s};
  find_ways(turn, next);
  std::vector<Intention> wishes(now.position.size());
  for_people(wishes.size(), [&](std::size_t first, std::size_t last) {
    std::vector<Surroundings::Near> near;
    for (std::size_t p = first; p < last; ++p) wishes[p] = choose(turn, next, p, near);
  });
  settle(turn, wishes, next);
  if (!knows_target_) next.crowd_best.improve(*landscape_, next.best, next.best_weighed, next.place, shifts);
}

double ProposedSwarm::avoid(Point at, Point heading_for, double rest_m) const {
  const SwarmOptions& options = landscape_->options();
  const double share = rest_m > 0 ? 1 : std::min(1.0, distance(at, heading_for) / options.slow_m);
  return options.avoid * share * share;
}

void ProposedSwarm::find_ways(const Turn& turn, State& next) const {
  const State& now = turn.now;
  for_people(now.position.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t p = first; p < last; ++p) {
      const Point target = landscape_->target(now.place[p], turn.shifts[landscape_->crowd(p)]);
      const double reached_m = landscape_->task().speed_mps[p] * step_s();
      const bool corner = now.rest_m[p] > 0 && distance(now.position[p], now.heading_for[p]) < reached_m;
      WayField::Toward way{target, 0};
      if (landscape_->has_ways() && !corner && (now.tick + p) % look_ticks_ != 0) {
        if (now.rest_m[p] > 0) way = {now.heading_for[p], now.rest_m[p]};
      } else if (landscape_->has_ways()) {
        way = landscape_->toward(p, now.position[p], target, turn.from_s);
      }
      // What was best on the last piece of the way means nothing on the next.
      if (way.rest_m != now.rest_m[p]) next.best[p] = now.position[p];
      next.heading_for[p] = way.at;
      next.rest_m[p] = way.rest_m;
    }
  });
}

ProposedSwarm::Option ProposedSwarm::judge(const Turn& turn, const Walker& walker, Point to) const {
  Option out;
  out.to = to;
  out.allowed = true;
  double squared = landscape_->still_squared(to, kFar);
  for (const Surroundings::Near& one : walker.near) {
    squared = std::min(squared, squared_length(to - one.at) * one.per_scope_square);
    const double now_square = squared_length(walker.at - one.at);
    const double room_square = one.room_m * one.room_m;
    const double swept_square = squared_to_segment(one.at, walker.at, to);
    if (swept_square < std::min(room_square, now_square) - kRounding_m) out.allowed = false;
  }
  // The hard boundary of Eq. 10; who is beyond it already may go where it is better.
  const double hardness = landscape_->options().hardness;
  if (squared < hardness - kRounding_m && squared <= walker.still_squared) out.allowed = false;
  if (out.allowed) out.allowed = landscape_->step_is_free(walker.at, to);
  out.disc_m = kFar;
  for (const Surroundings::Disc& disc : turn.around.discs()) {
    const double both_m = disc.radius_m + landscape_->scope_m(walker.person);
    squared = std::min(squared, squared_to_segment(to, disc.to, disc.ahead) / (both_m * both_m));
    const double keep_m =
        std::max(disc.radius_m + landscape_->task().radius_m[walker.person], std::sqrt(hardness) * both_m);
    const Approach approach = closest_approach({walker.at, to}, {disc.from, disc.to});
    out.disc_m = std::min(out.disc_m, approach.distance_m - keep_m);
  }
  const double ground = landscape_->ground_cost(to);
  const double objects = object_cost(squared);
  out.worst = std::max(objects, ground);
  out.weighed = std::max(walker.avoid * objects, landscape_->options().avoid * ground);
  out.value = landscape_->value(out.weighed, distance(to, walker.heading_for) + walker.rest_m);
  return out;
}

ProposedSwarm::Option ProposedSwarm::search(const Turn& turn, const Walker& walker, Point move, bool flees,
                                            Rng& rng) const {
  const SwarmOptions& options = landscape_->options();
  const auto better = [](const Option& a, const Option& b) {
    if (a.allowed != b.allowed) return a.allowed;
    if (a.free() != b.free()) return a.free();
    return a.free() ? a.value < b.value : a.disc_m > b.disc_m;
  };
  Option best;
  best.value = kFar;
  Point viewed = move;
  for (int n = 0; n < options.directions; ++n) {
    const double range = flees ? 2 * std::numbers::pi : std::numbers::pi;
    const Point tried = turned(move, (rng.uniform() - 0.5) * range);
    const Option option = judge(turn, walker, walker.at + tried);
    if (n > 0 && !better(option, best)) continue;
    best = option;
    viewed = tried;
  }
  for (int n = 1; n <= options.grid_steps; ++n) {
    for (const int side : {-1, 1}) {
      const Point tried = turned(viewed, side * n * options.grid_angle_rad);
      const Option option = judge(turn, walker, walker.at + tried);
      if (better(option, best)) best = option;
    }
  }
  return best;
}

ProposedSwarm::Intention ProposedSwarm::choose(const Turn& turn, const State& next, std::size_t p,
                                               std::vector<Surroundings::Near>& near) const {
  const SwarmOptions& options = landscape_->options();
  const MotionTask& task = landscape_->task();
  const State& now = turn.now;
  turn.around.look(p, near);
  Walker walker{p, now.position[p], next.heading_for[p], next.rest_m[p], near};
  walker.avoid = avoid(walker.at, walker.heading_for, walker.rest_m);
  walker.still_squared = landscape_->still_squared(walker.at, kFar);
  for (const auto& one : near) {
    walker.still_squared = std::min(walker.still_squared, squared_length(walker.at - one.at) * one.per_scope_square);
  }
  Option stay = judge(turn, walker, walker.at);
  stay.allowed = true;
  Rng rng = Rng(task.seed).split(p).split(now.tick + 1);
  Intention out{walker.at, now.direction[p], stay.weighed, rng.uniform(), better_place(turn, walker)};
  const double r1 = rng.uniform();
  const double r2 = rng.uniform();
  const bool flees = turn.around.threatens(p, walker.at);
  if (flees) {
    out.priority += 1;  // others wait for her
    walker.avoid = kFleeing;
  }

  const Point crowd_best = knows_target_ || walker.rest_m > 0
                               ? walker.heading_for
                               : walker.heading_for + now.crowd_best.offset[landscape_->crowd(p)];
  const Pull pull{options.inertia, options.cognitive * r1, options.social * r2};
  out.direction = next_direction(now.direction[p], walker.at, next.best[p], crowd_best, pull);
  const double to_target_m = distance(walker.at, walker.heading_for);
  const double fastest_m = task.speed_mps[p] * pace_[p] * landscape_->speed_factor(walker.at) * step_s();
  const double objects = object_cost(std::min(walker.still_squared, turn.around.nearest_squared(p, walker.at, near)));
  const double share =
      speed_share(objects, options.hardness, walker.rest_m > 0 ? options.slow_m : to_target_m, options.slow_m);
  const double step_m = flees ? fastest_m : std::min(fastest_m * share, to_target_m);
  if (step_m < kRounding_m) return out;

  Option taken = judge(turn, walker, walker.at + step_m * out.direction);
  if (flees || !taken.free() || rng.uniform() >= acceptance(taken.worst, options.hardness)) {
    taken = search(turn, walker, step_m * out.direction, flees, rng);
  }
  if (!taken.allowed || (!taken.free() && taken.disc_m <= stay.disc_m)) return out;
  out.to = taken.to;
  out.weighed = taken.weighed;
  out.direction = unit(taken.to - walker.at);
  return out;
}

std::uint32_t ProposedSwarm::better_place(const Turn& turn, const Walker& walker) const {
  const State& now = turn.now;
  const auto target = [&](std::size_t p) {
    return landscape_->target(now.place[p], turn.shifts[landscape_->crowd(p)]);
  };
  auto best = static_cast<std::uint32_t>(walker.person);
  if (walker.rest_m > 0 || now.rest_m[walker.person] > 0) return best;
  const Point own = target(walker.person);
  double gain = kGain_m2;
  for (const Surroundings::Near& one : walker.near) {
    const bool may = landscape_->exchange_class(one.who) == landscape_->exchange_class(walker.person) &&
                     landscape_->crowd(one.who) == landscape_->crowd(walker.person) && now.rest_m[one.who] == 0;
    if (!may) continue;
    // |p - a|^2 + |q - b|^2 - |p - b|^2 - |q - a|^2
    const double less = 2 * dot(walker.at - one.at, target(one.who) - own);
    if (less <= gain && !(less == gain && best != walker.person && one.who < best)) continue;
    gain = less;
    best = one.who;
  }
  return best;
}

bool ProposedSwarm::has_to_wait(const Turn& turn, std::span<const Intention> wishes, std::size_t p,
                                std::vector<Surroundings::Near>& near) const {
  const auto& at = turn.now.position;
  const Intention& own = wishes[p];
  const double own_m = distance(at[p], own.to);
  turn.around.look(p, near);
  return std::any_of(near.begin(), near.end(), [&](const Surroundings::Near& one) {
    const Intention& other = wishes[one.who];
    const double other_m = distance(one.at, other.to);
    const double now_m = distance(at[p], one.at);
    if (other_m <= 0 || now_m > one.room_m + own_m + other_m) return false;
    if (std::pair(own.priority, p) > std::pair(other.priority, static_cast<std::size_t>(one.who))) return false;
    return closest_approach({at[p], own.to}, {one.at, other.to}).distance_m < least_m(one.room_m, now_m);
  });
}

void ProposedSwarm::settle(const Turn& turn, std::span<const Intention> wishes, State& next) const {
  const State& now = turn.now;
  for_people(wishes.size(), [&](std::size_t first, std::size_t last) {
    std::vector<Surroundings::Near> near;
    for (std::size_t p = first; p < last; ++p) {
      const Intention& wish = wishes[p];
      next.direction[p] = wish.direction;
      const bool goes = wish.to != now.position[p] && !has_to_wait(turn, wishes, p, near);
      if (goes) next.position[p] = wish.to;
      next.velocity[p] = 1 / step_s() * (next.position[p] - now.position[p]);
      const std::uint32_t other = wish.exchange;
      if (other != p && wishes[other].exchange == p) {
        next.place[p] = now.place[other];
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
