// SPDX-License-Identifier: Apache-2.0
#include "planner/collective/pushes.hpp"

#include <array>
#include <cmath>

#include "planner/cpu_clones.hpp"
#include "planner/motion/lanes.hpp"

namespace footlight::planner::collective {
namespace {

using lanes::kLanes;
using Lanes = std::array<double, kLanes>;

/// Sums of both components, by lanes.
struct LaneSums {
  Lanes own_x{}, own_y{}, strangers_x{}, strangers_y{};
};

double total(const Lanes& lanes) {
  return ((lanes[0] + lanes[4]) + (lanes[2] + lanes[6])) + ((lanes[1] + lanes[5]) + (lanes[3] + lanes[7]));
}

/// @param people a multiple of kLanes
FOOTLIGHT_CPU_CLONES
void add_pushes(const double* x, const double* y, const double* touch_m, std::size_t people, Falloff repulsion,
                LaneSums& sums) {
  const double per_range = 1 / repulsion.range_m;
  for (std::size_t k = 0; k < people; k += kLanes) {
    for (std::size_t l = 0; l < kLanes; ++l) {
      const double long_m = std::sqrt(x[k + l] * x[k + l] + y[k + l] * y[k + l]);
      const double ranges = (long_m - touch_m[k + l]) * per_range;
      const double strength = repulsion.strength_mps2 * lanes::exp(-ranges) / long_m;
      const double felt = ranges < kCutOff ? strength : 0.0;
      sums.own_x[l] += felt * x[k + l];
      sums.own_y[l] += felt * y[k + l];
    }
  }
}

/// The same with strangers, who are felt by separation, too.
FOOTLIGHT_CPU_CLONES
void add_pushes_of_strangers(const double* x, const double* y, const double* touch_m, const double* stranger,
                             std::size_t people, Falloff repulsion, Falloff separation, LaneSums& sums) {
  const double per_range = 1 / repulsion.range_m;
  const double per_separation = 1 / separation.range_m;
  for (std::size_t k = 0; k < people; k += kLanes) {
    for (std::size_t l = 0; l < kLanes; ++l) {
      const double long_m = std::sqrt(x[k + l] * x[k + l] + y[k + l] * y[k + l]);
      const double room_m = long_m - touch_m[k + l];
      const double ranges = room_m * per_range;
      const double repulsed = repulsion.strength_mps2 * lanes::exp(-ranges) / long_m;
      const double felt = ranges < kCutOff ? repulsed : 0.0;
      const double apart = room_m * per_separation;
      const double separated = separation.strength_mps2 * lanes::exp(-apart) / long_m;
      const double strange = stranger[k + l] * (felt + (apart < kCutOff ? separated : 0.0));
      const double own = (1.0 - stranger[k + l]) * felt;
      sums.own_x[l] += own * x[k + l];
      sums.own_y[l] += own * y[k + l];
      sums.strangers_x[l] += strange * x[k + l];
      sums.strangers_y[l] += strange * y[k + l];
    }
  }
}

}  // namespace

void Around::clear(std::size_t most) {
  people_ = strangers_ = 0;
  // One more than there are, since who is not taken is written, too; and up to a whole number of lanes.
  const std::size_t room = most + 1 + kLanes;
  if (x_.size() >= room) return;
  for (auto* list : {&x_, &y_, &touch_m_, &stranger_}) list->resize(room);
}

Around::Sums Around::pushes(Falloff repulsion, Falloff separation) {
  const std::size_t whole = (people_ + kLanes - 1) / kLanes * kLanes;
  for (std::size_t k = people_; k < whole; ++k) {  // nobody, infinitely far beyond every reach
    x_[k] = 1;
    y_[k] = stranger_[k] = 0;
    touch_m_[k] = -std::numeric_limits<double>::infinity();
  }
  LaneSums sums;
  if (strangers_ > 0) {
    add_pushes_of_strangers(x_.data(), y_.data(), touch_m_.data(), stranger_.data(), whole, repulsion, separation,
                            sums);
  } else {
    add_pushes(x_.data(), y_.data(), touch_m_.data(), whole, repulsion, sums);
  }
  return {{total(sums.own_x), total(sums.own_y)}, {total(sums.strangers_x), total(sums.strangers_y)}};
}

}  // namespace footlight::planner::collective
