// SPDX-License-Identifier: Apache-2.0
#include "planner/swarm/surroundings.hpp"

#include <algorithm>
#include <cmath>

#include "planner/segment.hpp"

namespace footlight::planner::swarm {
namespace {

/// Beyond so many scopes a person costs nothing that matters: e^-6.
constexpr double kFarSquared = 6;
/// So far ahead one sees where a disc goes.
constexpr double kAhead_s = 3;

}  // namespace

Surroundings::Surroundings(const Landscape& landscape, std::span<const Point> people, double from_s, double to_s)
    : landscape_(&landscape), people_(people) {
  const MotionTask& task = landscape.task();
  double scope_m = 0;
  double radius_m = 0;
  double step_m = 0;
  for (std::size_t p = 0; p < people.size(); ++p) {
    scope_m = std::max(scope_m, landscape.scope_m(p));
    radius_m = std::max(radius_m, task.radius_m[p]);
    step_m = std::max(step_m, task.speed_mps[p] * (to_s - from_s));
  }
  const double far_squared = std::max(kFarSquared, landscape.options().hardness);
  reach_m_ = std::max(2 * scope_m * std::sqrt(far_squared), 2 * radius_m) + 2 * step_m;
  neighbours_.sort(people, std::max(reach_m_ / 2, 1e-3));
  const auto before = task.floor->discs(from_s);
  const auto after = task.floor->discs(to_s);
  for (std::size_t d = 0; d < before.size(); ++d) {
    discs_.push_back(
        {before[d].centre, after[d].centre, after[d].centre + kAhead_s * after[d].velocity, before[d].radius_m});
  }
}

void Surroundings::look(std::size_t person, std::vector<Near>& out) const {
  out.clear();
  const MotionTask& task = landscape_->task();
  const double scope_m = landscape_->scope_m(person);
  const double radius_m = task.radius_m[person];
  neighbours_.visit(people_[person], reach_m_, [&](std::uint32_t who, double) {
    if (who == person) return;
    const double both_m = scope_m + landscape_->scope_m(who);
    out.push_back({people_[who], 1 / (both_m * both_m), radius_m + task.radius_m[who], who});
  });
}

bool Surroundings::threatens(std::size_t person, Point at) const {
  return std::any_of(discs_.begin(), discs_.end(), [&](const Disc& disc) {
    // Room for one more beside it: who only just is not in its way stands in the way of those who are.
    const double clear_m = disc.radius_m + 3 * landscape_->scope_m(person);
    return squared_length(at - nearest_on(at, disc.to, disc.ahead)) < clear_m * clear_m;
  });
}

double Surroundings::nearest_squared(std::size_t person, Point at, const std::vector<Near>& near) const {
  double least = kFarSquared * 2;
  for (const Near& one : near) least = std::min(least, squared_length(at - one.at) * one.per_scope_square);
  for (const Disc& disc : discs_) {
    const double both_m = disc.radius_m + landscape_->scope_m(person);
    least = std::min(least, squared_length(at - nearest_on(at, disc.to, disc.ahead)) / (both_m * both_m));
  }
  return landscape_->still_squared(at, least);
}

}  // namespace footlight::planner::swarm
