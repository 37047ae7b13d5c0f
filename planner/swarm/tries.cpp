// SPDX-License-Identifier: Apache-2.0
#include "planner/swarm/tries.hpp"

#include <cmath>

#include "core/check.hpp"
#include "planner/cpu_clones.hpp"

namespace footlight::planner::swarm {
namespace {

using lanes::kLanes;
using Lanes = Tries::Lanes;

FOOTLIGHT_CPU_CLONES
void sweep_all(const Surroundings::Near* near, std::size_t count, const Lanes& x, const Lanes& y, Lanes& squared,
               Lanes& room) {
  Lanes per_square;
  for (std::size_t l = 0; l < kLanes; ++l) {
    const double square = x[l] * x[l] + y[l] * y[l];
    per_square[l] = square > 0 ? 1 / square : 0.0;
  }
  Lanes least_squared = squared;
  Lanes least_room = room;
  for (std::size_t n = 0; n < count; ++n) {
    const double away_x = near[n].away.x;
    const double away_y = near[n].away.y;
    const double per_scope_square = near[n].per_scope_square;
    const double keep_square = near[n].keep_square;
    for (std::size_t l = 0; l < kLanes; ++l) {
      const double end_x = x[l] - away_x;
      const double end_y = y[l] - away_y;
      const double end = (end_x * end_x + end_y * end_y) * per_scope_square;
      least_squared[l] = end < least_squared[l] ? end : least_squared[l];
      const double along = (away_x * x[l] + away_y * y[l]) * per_square[l];
      const double from_begin = along > 0.0 ? along : 0.0;
      const double share = from_begin < 1.0 ? from_begin : 1.0;
      const double by_x = away_x - share * x[l];
      const double by_y = away_y - share * y[l];
      const double spare = by_x * by_x + by_y * by_y - keep_square;
      least_room[l] = spare < least_room[l] ? spare : least_room[l];
    }
  }
  squared = least_squared;
  room = least_room;
}

FOOTLIGHT_CPU_CLONES
void weigh_all(const Aim& aim, Tries& tries) {
  for (std::size_t l = 0; l < kLanes; ++l) {
    const double objects = lanes::exp(-tries.squared[l]);
    const double ground = tries.ground[l];
    tries.worst[l] = objects > ground ? objects : ground;
    const double by_objects = aim.avoid * objects;
    const double by_ground = aim.avoid_ground * ground;
    tries.weighed[l] = by_objects > by_ground ? by_objects : by_ground;
    const double left_x = aim.way.x - tries.x[l];
    const double left_y = aim.way.y - tries.y[l];
    const double left_m = std::sqrt(left_x * left_x + left_y * left_y) + aim.rest_m;
    tries.value[l] = tries.weighed[l] + lanes::exp(left_m * left_m * aim.per_floor_square);
  }
}

FOOTLIGHT_CPU_CLONES
void turn_all(Point step, const Lanes& angle_rad, Lanes& x, Lanes& y) {
  for (std::size_t l = 0; l < kLanes; ++l) {
    const lanes::SineCosine turn = lanes::sine_cosine(angle_rad[l]);
    x[l] = turn.cosine * step.x - turn.sine * step.y;
    y[l] = turn.sine * step.x + turn.cosine * step.y;
  }
}

}  // namespace

void sweep(std::span<const Surroundings::Near> near, Tries& tries) {
  sweep_all(near.data(), near.size(), tries.x, tries.y, tries.squared, tries.room);
}

void weigh(const Aim& aim, Tries& tries) { weigh_all(aim, tries); }

void add_turned(Point step, std::span<const double> angle_rad, Tries& tries) {
  FL_CHECK(tries.size == 0 && angle_rad.size() <= kLanes);
  Lanes angle{};
  for (std::size_t l = 0; l < angle_rad.size(); ++l) angle[l] = angle_rad[l];
  turn_all(step, angle, tries.x, tries.y);
  tries.size = angle_rad.size();
}

}  // namespace footlight::planner::swarm
