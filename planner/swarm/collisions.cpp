// SPDX-License-Identifier: Apache-2.0
#include "planner/swarm/collisions.hpp"

#include <algorithm>

#include "planner/repair/closest_approach.hpp"

namespace footlight::planner::swarm {
namespace {

constexpr double kRounding_m = 1e-6;

}  // namespace

bool Collisions::meets_obstacle(std::size_t person, Point from, Point to, std::span<const MotionFloor::Disc> before,
                                std::span<const MotionFloor::Disc> after) const {
  if (!task_->floor->ways().straight(from, to)) return true;
  for (std::size_t d = 0; d < before.size(); ++d) {
    const double keep_m = before[d].radius_m + task_->radius_m[person];
    const Approach approach = closest_approach({from, to}, {before[d].centre, after[d].centre});
    if (approach.distance_m < keep_m - kRounding_m) return true;
  }
  return false;
}

void Collisions::step(std::span<const Point> now, std::span<const Point> wanted, double from_s, double to_s) {
  std::vector<Walk> walks;
  walks.reserve(now.size());
  double widest_m = 0;
  const auto before = task_->floor->discs(from_s);
  const auto after = task_->floor->discs(to_s);
  for (std::size_t p = 0; p < now.size(); ++p) {
    walks.push_back({now[p], wanted[p]});
    widest_m = std::max(widest_m, task_->radius_m[p]);
    const bool meets = meets_obstacle(p, now[p], wanted[p], before, after);
    if (meets && at_obstacle_[p] == 0) ++with_obstacles_;
    at_obstacle_[p] = meets ? 1 : 0;
  }
  std::vector<std::pair<std::uint32_t, std::uint32_t>> touching;
  for (const NearPair& pair : near_pairs(walks, 2 * widest_m)) {
    if (pair.approach.distance_m >= task_->radius_m[pair.a] + task_->radius_m[pair.b] - kRounding_m) continue;
    touching.emplace_back(pair.a, pair.b);
    if (!std::binary_search(touching_.begin(), touching_.end(), touching.back())) ++between_people_;
  }
  touching_ = std::move(touching);
}

}  // namespace footlight::planner::swarm
