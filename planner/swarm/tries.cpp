// SPDX-License-Identifier: Apache-2.0
#include "planner/swarm/tries.hpp"

#include <cmath>
#include <cstring>

#include "core/check.hpp"
#include "planner/cpu_clones.hpp"

namespace footlight::planner::swarm {
namespace {

using lanes::kLanes;
using Lanes = Tries::Lanes;

/// All lanes as one value: of loops over lanes inside of another loop compilers do not make vectors.
using Wide [[gnu::vector_size(sizeof(Lanes))]] = double;

FOOTLIGHT_CPU_CLONES
void sweep_all(const Surroundings::Near* near, std::size_t count, Tries& tries) {
  const Wide none = {};
  const Wide all = none + 1.0;
  Wide x, y, least_squared, least_room;
  std::memcpy(&x, tries.x.data(), sizeof x);
  std::memcpy(&y, tries.y.data(), sizeof y);
  std::memcpy(&least_squared, tries.squared.data(), sizeof least_squared);
  std::memcpy(&least_room, tries.room.data(), sizeof least_room);
  const Wide square = x * x + y * y;
  const Wide per_square = square > none ? all / square : none;
  for (std::size_t n = 0; n < count; ++n) {
    const double away_x = near[n].away.x;
    const double away_y = near[n].away.y;
    const Wide end_x = x - away_x;
    const Wide end_y = y - away_y;
    const Wide end = (end_x * end_x + end_y * end_y) * near[n].per_scope_square;
    least_squared = end < least_squared ? end : least_squared;
    const Wide along = (away_x * x + away_y * y) * per_square;
    const Wide from_begin = along > none ? along : none;
    const Wide share = from_begin < all ? from_begin : all;
    const Wide by_x = away_x - share * x;
    const Wide by_y = away_y - share * y;
    const Wide spare = by_x * by_x + by_y * by_y - near[n].keep_square;
    least_room = spare < least_room ? spare : least_room;
  }
  std::memcpy(tries.squared.data(), &least_squared, sizeof least_squared);
  std::memcpy(tries.room.data(), &least_room, sizeof least_room);
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

void sweep(std::span<const Surroundings::Near> near, Tries& tries) { sweep_all(near.data(), near.size(), tries); }

void weigh(const Aim& aim, Tries& tries) { weigh_all(aim, tries); }

void add_turned(Point step, std::span<const double> angle_rad, Tries& tries) {
  FL_CHECK(tries.size == 0 && angle_rad.size() <= kLanes);
  Lanes angle{};
  for (std::size_t l = 0; l < angle_rad.size(); ++l) angle[l] = angle_rad[l];
  turn_all(step, angle, tries.x, tries.y);
  tries.size = angle_rad.size();
}

}  // namespace footlight::planner::swarm
