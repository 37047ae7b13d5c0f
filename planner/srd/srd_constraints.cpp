// SPDX-License-Identifier: Apache-2.0
// What people ask of each other in a step: meetings to come, constraints, and the last pass that lets nobody run into
// anybody.
#include <algorithm>
#include <cmath>
#include <optional>

#include "planner/srd/constraints.hpp"
#include "planner/srd/srd_step.hpp"

namespace footlight::planner::srd {
namespace {

/// Corrections of constraints that hold at the same time are averaged, and the mean is lengthened by so much (Weiss et
/// al. 2017): what one of them alone asks is not cut by those that ask little.
constexpr double kOverRelaxed = 1.2;
/// Rounds in which a step is turned away from whoever it leads into, before it is shortened.
constexpr int kGuardRounds = 4;
/// Of lengths that are compared.
constexpr double kRounding = 1e-12;

}  // namespace

void SrdModel::Step::avoid() {
  if (options_.look_m <= 0) return;
  // As much as the iterations together would make good.
  const double strength = 1 - std::pow(1 - options_.avoidance, options_.iterations);
  for_people([&](std::size_t k) {
    const Point velocity = 1 / options_.step_s * (memory_.predicted[k] - here(k));
    memory_.x[k] = here(k).x;
    memory_.y[k] = here(k).y;
    memory_.x_mps[k] = velocity.x;
    memory_.y_mps[k] = velocity.y;
  });
  for_people([&](std::size_t k) {
    if (memory_.released[k] == 0) return;
    const Point sum = model_.agility_[who(k)] * aside(k, strength);
    memory_.predicted[k] = memory_.predicted[k] + within(sum, options_.step_s * memory_.pace_mps[k]);
  });
}

/// What all meetings to come ask of one person.
Point SrdModel::Step::aside(std::size_t k, double strength) const {
  const Moving me = moving(k);
  const double radius_m = memory_.radius_m[k];
  const std::int32_t group = memory_.group[k];
  const double most = options_.look_m * options_.look_m;
  const int alone = options_.formation ? 0 : 1;
  Point sum;
  const auto add = [&](const std::optional<Point>& one) {
    if (one) sum = sum + *one;
  };
  memory_.crowd.visit_rows(me.at, options_.look_m, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t j = begin; j < end; ++j) {
      const double dx = me.at.x - memory_.x[j];
      const double dy = me.at.y - memory_.y[j];
      const double vx = me.velocity.x - memory_.x_mps[j];
      const double vy = me.velocity.y - memory_.y_mps[j];
      const double nearing = dx * vx + dy * vy;
      const double apart_m = radius_m + memory_.radius_m[j];
      const double squared = dx * dx + dy * dy;
      const bool touches = nearing * nearing > (vx * vx + vy * vy) * (squared - apart_m * apart_m);
      const bool other = memory_.group[j] != group;
      // One branch, that is hardly ever taken: each of these alone is as good as chance.
      if ((static_cast<int>(nearing < 0) & static_cast<int>(touches) & static_cast<int>(squared <= most) &
           (static_cast<int>(other) | alone)) == 0) {
        continue;
      }
      add(avoidance(me, moving(j), apart_m, options_.step_s, options_.horizon_s, strength));
    }
  });
  for (const MotionFloor::Disc& disc : discs_) {
    const Moving it{disc.centre - options_.step_s * disc.velocity, disc.velocity};
    add(avoidance(me, it, radius_m + disc.radius_m, options_.step_s, options_.horizon_s, strength, 1));
  }
  return sum;
}

void SrdModel::Step::solve() {
  for (int n = 0; n < options_.iterations; ++n) {
    for_people([&](std::size_t k) { memory_.other[k] = corrected(k); });
    memory_.predicted.swap(memory_.other);
  }
}

/// All constraints of one person from the same generation of p*.
Point SrdModel::Step::corrected(std::size_t k) const {
  const Point me = memory_.predicted[k];
  const double radius_m = memory_.radius_m[k];
  Point sum;
  int active = 0;
  const auto add = [&](const std::optional<Point>& one) {
    if (!one) return;
    sum = sum + *one;
    ++active;
  };
  visit_near(k, [&](std::uint32_t j) { add(separation(me, memory_.predicted[j], radius_m + memory_.radius_m[j])); });
  for (const MotionFloor::Disc& disc : discs_) add(separation(me, disc.centre, radius_m + disc.radius_m, 1));
  Point to = me;
  if (options_.formation && memory_.released[k] == 0) {
    to = to + formation(me, memory_.destination[k], options_.stiffness);
  }
  if (active > 0) to = to + kOverRelaxed / active * sum;
  if (!model_.floor_.open()) to = model_.floor_.pushed_out(to);
  const Point low = task_.floor->low();
  const Point high = task_.floor->high();
  to = {std::clamp(to.x, low.x, high.x), std::clamp(to.y, low.y, high.y)};
  return here(k) + within(to - here(k), options_.step_s * memory_.pace_mps[k]);
}

void SrdModel::Step::guard() {
  const Point low = task_.floor->low();
  const Point high = task_.floor->high();
  const bool open = model_.floor_.open();
  for_people([&](std::size_t k) {
    const Point from = here(k);
    const Point step = allowed(k, memory_.predicted[k] - from);
    const Point there = from + step;
    const bool inside = there.x >= low.x && there.x <= high.x && there.y >= low.y && there.y <= high.y;
    const bool free = inside && (open || model_.floor_.free_m(from) >= length(step));
    memory_.other[k] = from + (free ? 1 : task_.floor->free_share(from, there)) * step;
  });
  memory_.predicted.swap(memory_.other);
}

/// The step, turned and shortened so that it leads nobody by more than half of the gap toward anybody. If both keep to
/// that the gap cannot close, whatever the others do.
Point SrdModel::Step::allowed(std::size_t k, Point step) const {
  const Point from = here(k);
  const double radius_m = memory_.radius_m[k];
  // Who is farther than a gap of two steps is not run into.
  const auto each = [&](auto meet) {
    const double step_m = (1 + kRounding) * length(step);
    visit_near(k, [&](std::uint32_t j) {
      const Point toward = here(j) - from;
      const double squared = squared_length(toward);
      const double apart_m = radius_m + memory_.radius_m[j];
      const double harmless_m = apart_m + 2 * step_m;
      if (squared <= 0 || squared > harmless_m * harmless_m) return;
      const double far_m = std::sqrt(squared);
      meet(1 / far_m * toward, std::max(0.0, (far_m - apart_m) / 2));
    });
    for (const MotionFloor::Disc& disc : discs_) {
      const Point toward = disc.centre - from;
      const double far_m = length(toward);
      if (far_m > 0) meet(1 / far_m * toward, std::max(0.0, far_m - radius_m - disc.radius_m));
    }
  };
  for (int round = 0; round < kGuardRounds; ++round) {
    Point back;
    double weight = 0;
    each([&](Point toward, double most) {
      const double over = dot(step, toward) - most;
      if (over <= 0) return;
      back = back + over * over * toward;
      weight += over;
    });
    if (weight <= 0) return step;
    step = step - 1 / weight * back;
  }
  double share = 1;
  each([&](Point toward, double most) {
    const double there = dot(step, toward);
    if (there > most) share = std::min(share, most / there);
  });
  return within(share * step, options_.step_s * memory_.pace_mps[k]);
}

}  // namespace footlight::planner::srd
