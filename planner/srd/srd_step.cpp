// SPDX-License-Identifier: Apache-2.0
#include "planner/srd/srd_step.hpp"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "planner/srd/constraints.hpp"

namespace footlight::planner::srd {
namespace {

constexpr std::size_t kChunk = 256;
/// Corrections of constraints that hold at the same time are averaged, and the mean is lengthened by so much (Weiss et
/// al. 2017): what one of them alone asks is not cut by those that ask little.
constexpr double kOverRelaxed = 1.2;
/// How soon somebody wants to be where her destination is, s.
constexpr double kArrive_s = 1;
/// A corner that is so near has been reached.
constexpr double kReached_m = 0.5;
/// Rounds in which a step is turned away from whoever it leads into, before it is shortened.
constexpr int kGuardRounds = 4;

}  // namespace

SrdModel::Step::Step(const SrdModel& model, const State& now, State& next)
    : model_(model),
      task_(*model.task_),
      options_(model.options_),
      now_(now),
      next_(next),
      at_s_(options_.step_s * static_cast<double>(now.tick + 1)),
      discs_(task_.floor->discs(at_s_)),
      pace_mps_(task_.speed_mps),
      destination_(task_.people()),
      destination_mps_(task_.people()),
      predicted_(task_.people()),
      other_(task_.people()),
      chunks_((task_.people() + kChunk - 1) / kChunk) {}

template <class Work>
void SrdModel::Step::for_people(Work work) const {
  tbb::parallel_for(std::size_t{0}, chunks_.size(), [&](std::size_t chunk) {
    const std::size_t end = std::min(task_.people(), (chunk + 1) * kChunk);
    for (std::size_t i = chunk * kChunk; i < end; ++i) work(i);
  });
}

template <class Visit>
void SrdModel::Step::visit_near(std::size_t i, Visit visit) const {
  const Chunk& chunk = chunks_[i / kChunk];
  const std::size_t n = i % kChunk;
  for (std::uint32_t k = chunk.begin[n]; k < chunk.begin[n + 1]; ++k) visit(chunk.near[k]);
}

void SrdModel::Step::run() {
  plan();
  find_congestion();
  find_neighbours();
  avoid();
  solve();
  guard();
  move();
}

void SrdModel::Step::plan() {
  std::vector<Placing> before;
  std::vector<Placing> after;
  for (const March& march : model_.groups_.march) {
    before.emplace_back(march.at(at_s_ - options_.step_s));
    after.emplace_back(march.at(at_s_));
  }
  const bool level = task_.floor->level();
  for_people([&](std::size_t i) {
    if (!level) pace_mps_[i] *= task_.floor->speed_factor(now_.position[i]);
    const auto group = static_cast<std::size_t>(model_.groups_.of[i]);
    const Offsets& offsets = model_.groups_.offsets[i];
    if (options_.formation) {
      const Point destination = after[group](offsets);
      plan_in_formation(i, destination, 1 / options_.step_s * (destination - before[group](offsets)));
    } else {
      plan_for_herself(i);
    }
    const Point blended = (1 - options_.blending) * now_.velocity[i] + options_.blending * destination_mps_[i];
    predicted_[i] = now_.position[i] + options_.step_s * within(blended, pace_mps_[i]);
  });
}

void SrdModel::Step::plan_in_formation(std::size_t i, Point destination, Point velocity) {
  destination_[i] = model_.floor_.free_place(destination);
  destination_mps_[i] = velocity;
  const Point here = now_.position[i];
  // The formation does not bring back who is out of it, and by steering alone she would be long in coming.
  if (now_.released[i] != 0 && distance(here, destination) > options_.congestion_m / 2) {
    destination_mps_[i] = seek(here, destination_[i], velocity, kArrive_s, pace_mps_[i]);
  }
  go_around(i);
}

/// To the place at the end over the corners of the group's way, as fast as it takes to be there in time.
void SrdModel::Step::plan_for_herself(std::size_t i) {
  const March& march = model_.groups_.march[static_cast<std::size_t>(model_.groups_.of[i])];
  const Offsets& offsets = model_.groups_.offsets[i];
  const auto& corners = march.corners();
  const auto corner = [&](std::size_t n) {
    return model_.floor_.free_place(n + 1 < corners.size() ? corners[n] + offsets.from : corners.back() + offsets.to);
  };
  std::uint32_t& passed = next_.passed[i];
  while (passed + 1 < corners.size() &&
         dot(now_.position[i] - corner(passed), corner(passed + 1) - corner(passed)) >= 0) {
    ++passed;
  }
  const std::size_t target = std::min<std::size_t>(passed, corners.size() - 1);
  destination_[i] = corner(target);
  double left_m = distance(now_.position[i], destination_[i]);
  for (std::size_t n = target; n + 1 < corners.size(); ++n) left_m += distance(corner(n), corner(n + 1));
  const double left_s = std::max(march.arrives_s() - (at_s_ - options_.step_s), options_.step_s);
  go_around(i);
  destination_mps_[i] =
      within(1 / options_.step_s * (destination_[i] - now_.position[i]), std::min(pace_mps_[i], left_m / left_s));
}

/// Who does not see her destination goes to the next corner of the way there, as fast as she can.
void SrdModel::Step::go_around(std::size_t i) {
  if (model_.floor_.open()) return;
  const Point here = now_.position[i];
  next_.around[i] = model_.floor_.sees(here, destination_[i]) ? 0 : 1;
  if (next_.around[i] == 0) return;
  const bool keeps =
      now_.around[i] != 0 && distance(here, now_.corner[i]) > kReached_m && model_.floor_.sees(here, now_.corner[i]);
  if (!keeps) next_.corner[i] = model_.floor_.first_corner(here, destination_[i]);
  destination_[i] = next_.corner[i];
  destination_mps_[i] = within(1 / options_.step_s * (destination_[i] - here), pace_mps_[i]);
}

void SrdModel::Step::find_congestion() {
  if (!options_.formation) return;
  Congestion congestion(task_.floor->low(), task_.floor->high(), options_.congestion_m);
  congestion.fill(predicted_, model_.groups_.of);
  for (const MotionFloor::Disc& disc : discs_) congestion.add(disc);
  for_people([&](std::size_t i) {
    const bool crowded = congestion.meets_others(predicted_[i], model_.groups_.of[i]);
    double& waited_s = next_.waited_s[i];
    waited_s = crowded == (now_.released[i] != 0) ? 0 : waited_s + options_.step_s;
    if (waited_s <= 0 || waited_s < model_.reaction_s_[i]) return;
    next_.released[i] = crowded ? 1 : 0;
    waited_s = 0;
  });
}

double SrdModel::Step::reach_m(std::size_t i) const {
  return model_.radius_m_[i] + model_.widest_m_ + options_.step_s * (task_.speed_mps[i] + model_.fastest_mps_);
}

void SrdModel::Step::find_neighbours() {
  crowd_.sort(now_.position, 2 * model_.widest_m_ + 2 * options_.step_s * model_.fastest_mps_);
  tbb::parallel_for(std::size_t{0}, chunks_.size(), [&](std::size_t c) {
    Chunk& chunk = chunks_[c];
    const std::size_t end = std::min(task_.people(), (c + 1) * kChunk);
    chunk.begin.assign(1, 0);
    for (std::size_t i = c * kChunk; i < end; ++i) {
      crowd_.visit(now_.position[i], reach_m(i), [&](std::uint32_t j, double) {
        if (j != i) chunk.near.push_back(j);
      });
      chunk.begin.push_back(static_cast<std::uint32_t>(chunk.near.size()));
    }
  });
}

void SrdModel::Step::avoid() {
  // As much as the iterations together would make good.
  const double k = 1 - std::pow(1 - options_.avoidance, options_.iterations);
  const auto moving = [&](std::size_t i) {
    return Moving{now_.position[i], 1 / options_.step_s * (predicted_[i] - now_.position[i])};
  };
  other_ = predicted_;
  for_people([&](std::size_t i) {
    if (next_.released[i] == 0 || options_.look_m <= 0) return;
    const Moving me = moving(i);
    Point sum;
    crowd_.visit(me.at, options_.look_m, [&](std::uint32_t j, double) {
      if (j == i || (options_.formation && model_.groups_.of[j] == model_.groups_.of[i])) return;
      const double apart_m = model_.radius_m_[i] + model_.radius_m_[j];
      if (const auto one = avoidance(me, moving(j), apart_m, options_.step_s, options_.horizon_s, k)) sum = sum + *one;
    });
    for (const MotionFloor::Disc& disc : discs_) {
      const double apart_m = model_.radius_m_[i] + disc.radius_m;
      const Moving it{disc.centre - options_.step_s * disc.velocity, disc.velocity};
      if (const auto one = avoidance(me, it, apart_m, options_.step_s, options_.horizon_s, k, 1)) sum = sum + *one;
    }
    other_[i] = predicted_[i] + within(model_.agility_[i] * sum, options_.step_s * pace_mps_[i]);
  });
  predicted_.swap(other_);
}

void SrdModel::Step::solve() {
  for (int n = 0; n < options_.iterations; ++n) {
    for_people([&](std::size_t i) { other_[i] = corrected(i); });
    predicted_.swap(other_);
  }
}

/// All constraints of one person from the same generation of p*.
Point SrdModel::Step::corrected(std::size_t i) const {
  const Point me = predicted_[i];
  Point sum;
  int active = 0;
  const auto add = [&](const std::optional<Point>& one) {
    if (!one) return;
    sum = sum + *one;
    ++active;
  };
  visit_near(i,
             [&](std::uint32_t j) { add(separation(me, predicted_[j], model_.radius_m_[i] + model_.radius_m_[j])); });
  for (const MotionFloor::Disc& disc : discs_) add(separation(me, disc.centre, model_.radius_m_[i] + disc.radius_m, 1));
  Point to = me;
  if (options_.formation && next_.released[i] == 0) to = to + formation(me, destination_[i], options_.stiffness);
  if (active > 0) to = to + kOverRelaxed / active * sum;
  to = model_.floor_.pushed_out(to);
  const Point low = task_.floor->low();
  const Point high = task_.floor->high();
  to = {std::clamp(to.x, low.x, high.x), std::clamp(to.y, low.y, high.y)};
  return now_.position[i] + within(to - now_.position[i], options_.step_s * pace_mps_[i]);
}

void SrdModel::Step::guard() {
  const Point low = task_.floor->low();
  const Point high = task_.floor->high();
  for_people([&](std::size_t i) {
    const Point here = now_.position[i];
    const Point step = allowed(i, predicted_[i] - here);
    const Point there = here + step;
    const bool inside = there.x >= low.x && there.x <= high.x && there.y >= low.y && there.y <= high.y;
    const bool free = inside && model_.floor_.free_m(here) >= length(step);
    other_[i] = here + (free ? 1 : task_.floor->free_share(here, there)) * step;
  });
  predicted_.swap(other_);
}

/// The step, turned and shortened so that it leads nobody by more than half of the gap toward anybody. If both keep to
/// that the gap cannot close, whatever the others do.
Point SrdModel::Step::allowed(std::size_t i, Point step) const {
  const Point here = now_.position[i];
  const auto each = [&](auto meet) {
    visit_near(i, [&](std::uint32_t j) {
      const Point toward = now_.position[j] - here;
      const double far_m = length(toward);
      if (far_m <= 0) return;
      meet(1 / far_m * toward, std::max(0.0, (far_m - model_.radius_m_[i] - model_.radius_m_[j]) / 2));
    });
    for (const MotionFloor::Disc& disc : discs_) {
      const Point toward = disc.centre - here;
      const double far_m = length(toward);
      if (far_m > 0) meet(1 / far_m * toward, std::max(0.0, far_m - model_.radius_m_[i] - disc.radius_m));
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
  return within(share * step, options_.step_s * pace_mps_[i]);
}

/// v_d of Eq. 10.
Point SrdModel::Step::desired(std::size_t i) const {
  if (next_.around[i] != 0) return destination_mps_[i];
  return seek(predicted_[i], destination_[i], destination_mps_[i], kArrive_s, pace_mps_[i]);
}

void SrdModel::Step::move() {
  for_people([&](std::size_t i) {
    next_.position[i] = predicted_[i];
    Point velocity = 1 / options_.step_s * (predicted_[i] - now_.position[i]);
    if (options_.formation) velocity = velocity + options_.steering * (desired(i) - velocity);
    next_.velocity[i] = within(velocity, pace_mps_[i]);
  });
}

}  // namespace footlight::planner::srd
