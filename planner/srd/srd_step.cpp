// SPDX-License-Identifier: Apache-2.0
#include "planner/srd/srd_step.hpp"

#include <algorithm>
#include <span>

#include <tbb/parallel_for.h>

#include "planner/srd/constraints.hpp"

namespace footlight::planner::srd {
namespace {

/// How soon somebody wants to be where her destination is, s.
constexpr double kArrive_s = 1;
/// A corner that is so near has been reached.
constexpr double kReached_m = 0.5;

}  // namespace

SrdModel::Step::Step(const SrdModel& model, const State& now, State& next, StepMemory& memory)
    : model_(model),
      task_(*model.task_),
      options_(model.options_),
      now_(now),
      next_(next),
      memory_(memory),
      at_s_(options_.step_s * static_cast<double>(now.tick + 1)),
      discs_(task_.floor->discs(at_s_)) {
  const std::size_t people = task_.people();
  memory_.radius_m.resize(people);
  memory_.pace_mps.resize(people);
  memory_.group.resize(people);
  memory_.released.resize(people);
  for (auto* points : {&memory_.destination, &memory_.destination_mps, &memory_.predicted, &memory_.other}) {
    points->resize(people);
  }
  for (auto* numbers : {&memory_.x, &memory_.y, &memory_.x_mps, &memory_.y_mps}) numbers->resize(people);
  memory_.chunks.resize((people + kChunk - 1) / kChunk);
}

void SrdModel::Step::run() {
  sort();
  plan();
  find_congestion();
  find_neighbours();
  avoid();
  solve();
  guard();
  move();
}

void SrdModel::Step::sort() {
  memory_.crowd.sort(now_.position, 2 * model_.widest_m_ + 2 * options_.step_s * model_.fastest_mps_);
  const bool level = task_.floor->level();
  for_people([&](std::size_t k) {
    const std::uint32_t i = who(k);
    memory_.radius_m[k] = model_.radius_m_[i];
    memory_.group[k] = model_.groups_.of[i];
    memory_.pace_mps[k] = level ? task_.speed_mps[i] : task_.speed_mps[i] * task_.floor->speed_factor(here(k));
  });
}

void SrdModel::Step::plan() {
  std::vector<Placing> before;
  std::vector<Placing> after;
  for (const March& march : model_.groups_.march) {
    before.emplace_back(march.at(at_s_ - options_.step_s));
    after.emplace_back(march.at(at_s_));
  }
  for_people([&](std::size_t k) {
    const std::uint32_t i = who(k);
    if (options_.formation) {
      const auto group = static_cast<std::size_t>(memory_.group[k]);
      const Offsets& offsets = model_.groups_.offsets[i];
      const Point destination = after[group](offsets);
      plan_in_formation(k, destination, 1 / options_.step_s * (destination - before[group](offsets)));
    } else {
      plan_for_herself(k);
    }
    const Point blended = (1 - options_.blending) * now_.velocity[i] + options_.blending * memory_.destination_mps[k];
    memory_.predicted[k] = here(k) + options_.step_s * within(blended, memory_.pace_mps[k]);
  });
}

void SrdModel::Step::plan_in_formation(std::size_t k, Point destination, Point velocity) {
  memory_.destination[k] = model_.floor_.open() ? destination : model_.floor_.free_place(destination);
  memory_.destination_mps[k] = velocity;
  const double far_m = options_.congestion_m / 2;
  // The formation does not bring back who is out of it, and by steering alone she would be long in coming.
  if (now_.released[who(k)] != 0 && squared_length(here(k) - destination) > far_m * far_m) {
    memory_.destination_mps[k] = seek(here(k), memory_.destination[k], velocity, kArrive_s, memory_.pace_mps[k]);
  }
  go_around(k);
}

/// To the place at the end over the corners of the group's way, as fast as it takes to be there in time.
void SrdModel::Step::plan_for_herself(std::size_t k) {
  const std::uint32_t i = who(k);
  const March& march = model_.groups_.march[static_cast<std::size_t>(memory_.group[k])];
  const Offsets& offsets = model_.groups_.offsets[i];
  const auto& corners = march.corners();
  const auto corner = [&](std::size_t n) {
    return model_.floor_.free_place(n + 1 < corners.size() ? corners[n] + offsets.from : corners.back() + offsets.to);
  };
  std::uint32_t& passed = next_.passed[i];
  while (passed + 1 < corners.size() && dot(here(k) - corner(passed), corner(passed + 1) - corner(passed)) >= 0) {
    ++passed;
  }
  const std::size_t target = std::min<std::size_t>(passed, corners.size() - 1);
  memory_.destination[k] = corner(target);
  double left_m = distance(here(k), memory_.destination[k]);
  for (std::size_t n = target; n + 1 < corners.size(); ++n) left_m += distance(corner(n), corner(n + 1));
  const double left_s = std::max(march.arrives_s() - (at_s_ - options_.step_s), options_.step_s);
  go_around(k);
  memory_.destination_mps[k] =
      within(1 / options_.step_s * (memory_.destination[k] - here(k)), std::min(memory_.pace_mps[k], left_m / left_s));
}

/// Who does not see her destination goes to the next corner of the way there, as fast as she can.
void SrdModel::Step::go_around(std::size_t k) {
  if (model_.floor_.open()) return;
  const std::uint32_t i = who(k);
  const Point from = here(k);
  next_.around[i] = model_.floor_.sees(from, memory_.destination[k]) ? 0 : 1;
  if (next_.around[i] == 0) return;
  const bool keeps =
      now_.around[i] != 0 && distance(from, now_.corner[i]) > kReached_m && model_.floor_.sees(from, now_.corner[i]);
  if (!keeps) next_.corner[i] = model_.floor_.first_corner(from, memory_.destination[k]);
  memory_.destination[k] = next_.corner[i];
  memory_.destination_mps[k] = within(1 / options_.step_s * (memory_.destination[k] - from), memory_.pace_mps[k]);
}

void SrdModel::Step::find_congestion() {
  if (options_.formation) {
    Congestion congestion(task_.floor->low(), task_.floor->high(), options_.congestion_m);
    congestion.fill(memory_.predicted, memory_.group);
    for (const MotionFloor::Disc& disc : discs_) congestion.add(disc);
    for_people([&](std::size_t k) {
      const std::uint32_t i = who(k);
      const bool crowded = congestion.meets_others(memory_.predicted[k], memory_.group[k]);
      double& waited_s = next_.waited_s[i];
      waited_s = crowded == (now_.released[i] != 0) ? 0 : waited_s + options_.step_s;
      if (waited_s <= 0 || waited_s < model_.reaction_s_[i]) return;
      next_.released[i] = crowded ? 1 : 0;
      waited_s = 0;
    });
  }
  for_people([&](std::size_t k) { memory_.released[k] = next_.released[who(k)]; });
}

void SrdModel::Step::find_neighbours() {
  const std::span<const Point> places = memory_.crowd.places();
  tbb::parallel_for(std::size_t{0}, memory_.chunks.size(), [&](std::size_t c) {
    StepMemory::Chunk& chunk = memory_.chunks[c];
    const std::size_t end = std::min(task_.people(), (c + 1) * kChunk);
    chunk.begin.assign(1, 0);
    chunk.near.clear();
    for (std::size_t k = c * kChunk; k < end; ++k) {
      const double reach_m =
          memory_.radius_m[k] + model_.widest_m_ + options_.step_s * (memory_.pace_mps[k] + model_.fastest_mps_);
      memory_.crowd.visit_rows(places[k], reach_m, [&](std::uint32_t begin, std::uint32_t stop) {
        for (std::uint32_t j = begin; j < stop; ++j) {
          if (j != k && squared_length(places[j] - places[k]) <= reach_m * reach_m) chunk.near.push_back(j);
        }
      });
      chunk.begin.push_back(static_cast<std::uint32_t>(chunk.near.size()));
    }
  });
}

/// v_d of Eq. 10.
Point SrdModel::Step::desired(std::size_t k) const {
  if (next_.around[who(k)] != 0) return memory_.destination_mps[k];
  return seek(memory_.predicted[k], memory_.destination[k], memory_.destination_mps[k], kArrive_s, memory_.pace_mps[k]);
}

void SrdModel::Step::move() {
  for_people([&](std::size_t k) {
    const std::uint32_t i = who(k);
    next_.position[i] = memory_.predicted[k];
    Point velocity = 1 / options_.step_s * (memory_.predicted[k] - here(k));
    if (options_.formation) velocity = velocity + options_.steering * (desired(k) - velocity);
    next_.velocity[i] = within(velocity, memory_.pace_mps[k]);
  });
}

}  // namespace footlight::planner::srd
