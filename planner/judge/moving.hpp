// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "core/plan.hpp"
#include "planner/judge/walks.hpp"

namespace footlight::planner::judge {

/// The obstacles that move through a plan's sections, each while its section lasts.
class MovingObstacles {
 public:
  explicit MovingObstacles(const Plan& plan) : sections_(&plan.sections) {}

  /// How near somebody comes to the edge of one.
  struct Hit {
    std::size_t section = 0;
    std::size_t obstacle = 0;  ///< of the section, from 0
    double distance_m = 0;     ///< 0 inside
    Instant at;
  };
  /// Obstacles whose edge is nearer than `limit_m` on a straight, even walk, where they are nearest. Closed form for
  /// each stretch on which both go straight. O(sections + obstacles x their marks in the meantime)
  [[nodiscard]] std::vector<Hit> nearer_than(const Stand& from, const Stand& to, double limit_m) const;

 private:
  const std::vector<PlanSection>* sections_;
};

}  // namespace footlight::planner::judge
