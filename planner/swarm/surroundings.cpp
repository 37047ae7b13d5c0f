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
constexpr double kRounding_m = 1e-9;

}  // namespace

void Surroundings::sort(const Landscape& landscape, std::span<const Point> people, double from_s, double to_s) {
  landscape_ = &landscape;
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
  touch_m_ = 2 * radius_m + 2 * step_m + kRounding_m;
  reach_m_ = std::max(2 * scope_m * std::sqrt(far_squared), 2 * radius_m) + 2 * step_m;
  neighbours_.sort(people, std::max(reach_m_ / 2, 1e-3));
  scope_m_.resize(people.size());
  radius_m_.resize(people.size());
  for_people(people.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      scope_m_[k] = landscape.scope_m(order()[k]);
      radius_m_[k] = task.radius_m[order()[k]];
    }
  });
  discs_.clear();
  const auto before = task.floor->discs(from_s);
  const auto after = task.floor->discs(to_s);
  for (std::size_t d = 0; d < before.size(); ++d) {
    discs_.push_back(
        {before[d].centre, after[d].centre, after[d].centre + kAhead_s * after[d].velocity, before[d].radius_m});
  }
}

void Surroundings::look(std::size_t rank, std::vector<Near>& out) const {
  const Point here = places()[rank];
  const double squared_reach = reach_m_ * reach_m_;
  std::size_t taken = 0;
  neighbours_.visit_rows(here, reach_m_, [&](std::uint32_t begin, std::uint32_t end) {
    if (out.size() < taken + (end - begin) + 1) out.resize(taken + (end - begin) + 1);
    for (std::uint32_t other = begin; other < end; ++other) {
      // Written whether she is taken or not, without a branch, since nothing foretells it.
      Near& one = out[taken];
      one.away = places()[other] - here;
      one.rank = other;
      const auto near = static_cast<std::size_t>(squared_length(one.away) <= squared_reach);
      taken += near & static_cast<std::size_t>(other != rank);
    }
  });
  out.resize(taken);
  for (Near& one : out) {
    const double both_m = scope_m_[rank] + scope_m_[one.rank];
    one.per_scope_square = 1 / (both_m * both_m);
    const double room_m = radius_m_[rank] + radius_m_[one.rank];
    one.keep_square = std::min(room_m * room_m, squared_length(one.away)) - kRounding_m;
  }
}

bool Surroundings::threatens(std::size_t person, Point at) const {
  return std::any_of(discs_.begin(), discs_.end(), [&](const Disc& disc) {
    // Room for one more beside it: who only just is not in its way stands in the way of those who are.
    const double clear_m = disc.radius_m + 3 * landscape_->scope_m(person);
    return squared_length(at - nearest_on(at, disc.to, disc.ahead)) < clear_m * clear_m;
  });
}

double Surroundings::disc_squared(std::size_t person, Point at, double beyond) const {
  for (const Disc& disc : discs_) {
    const double both_m = disc.radius_m + landscape_->scope_m(person);
    beyond = std::min(beyond, squared_length(at - nearest_on(at, disc.to, disc.ahead)) / (both_m * both_m));
  }
  return beyond;
}

}  // namespace footlight::planner::swarm
