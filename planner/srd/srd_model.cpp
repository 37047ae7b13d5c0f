// SPDX-License-Identifier: Apache-2.0
#include "planner/srd/srd_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/rng.hpp"
#include "planner/srd/open_ranks.hpp"
#include "planner/srd/srd_step.hpp"

namespace footlight::planner::srd {
SrdModel::SrdModel(const MotionTask& task, const SrdOptions& options)
    : task_(&task), options_(options), floor_(*task.floor) {}

Result<SrdModel> SrdModel::make(const MotionTask& task, const SrdOptions& options) {
  SrdModel model(task, options);
  auto groups = divide(task, options, model.floor_);
  if (!groups) return groups.error();
  model.groups_ = std::move(*groups);
  model.spread();
  model.make_room();
  return model;
}

/// How people differ in agility and reaction: each as she is, who says nothing by chance.
void SrdModel::spread() {
  const std::size_t people = task_->people();
  agility_.resize(people);
  reaction_s_.resize(people);
  const Rng rng(task_->seed);
  for (std::size_t i = 0; i < people; ++i) {
    Rng own = rng.split(i);
    const double agility = options_.agility * (1 + options_.variation * (2 * own.uniform() - 1));
    const double reaction_s = options_.reaction_s * (1 + options_.variation * (2 * own.uniform() - 1));
    agility_[i] = task_->agility.empty() ? agility : task_->agility[i].value_or(agility);
    reaction_s_[i] = task_->reaction_s.empty() ? reaction_s : task_->reaction_s[i].value_or(reaction_s);
    fastest_mps_ = std::max(fastest_mps_, task_->speed_mps[i]);
  }
}

/// More than bodies need, so that people still pass each other when they are put on cells; less where formations are so
/// dense that others could not come through.
void SrdModel::make_room() {
  radius_m_ = task_->radius_m;
  std::vector<double> room_m(radius_m_.size(), options_.room_m / 2);
  const double look_m = kPassable * options_.room_m;
  for (const auto* places : {&task_->from, &task_->to}) {
    if (places->empty() || look_m <= 0) continue;
    const std::vector<double> nearest = nearest_others(*places, look_m);
    for (std::size_t i = 0; i < radius_m_.size(); ++i) {
      const double here_m = nearest[places == &task_->from ? i : groups_.place_of[i]];
      room_m[i] = std::min(room_m[i], here_m / kPassable / 2);
    }
  }
  for (std::size_t i = 0; i < radius_m_.size(); ++i) {
    radius_m_[i] = std::max(radius_m_[i], room_m[i]);
    widest_m_ = std::max(widest_m_, radius_m_[i]);
  }
}

SrdModel::State SrdModel::begin() const {
  State state;
  const std::size_t people = task_->people();
  state.position = task_->from;
  state.velocity.assign(people, {});
  state.released.assign(people, options_.formation ? 0 : 1);
  state.waited_s.assign(people, 0);
  state.around.assign(people, 0);
  state.corner.assign(people, {});
  state.passed.assign(people, 1);
  return state;
}

std::vector<Point> SrdModel::destinations(double at_s) const {
  std::vector<Placing> places;
  places.reserve(groups_.march.size());
  for (const March& march : groups_.march) places.emplace_back(march.at(at_s));
  std::vector<Point> out(groups_.of.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = floor_.free_place(places[static_cast<std::size_t>(groups_.of[i])](groups_.offsets[i]));
  }
  return out;
}

void SrdModel::step(const State& now, State& next) const {
  const auto memory = memory_.take();
  Step(*this, now, next, *memory).run();
}

}  // namespace footlight::planner::srd
