// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "planner/motion/model.hpp"
#include "planner/swarm/crowd_best.hpp"
#include "planner/swarm/landscape.hpp"

namespace footlight::planner::swarm {

/// The original particle swarm as a crowd: Eq. 2-3 of Lin 2007, as section 4.1 there uses it. What is in the way counts
/// in the cost (Eq. 9) alone, and other people not at all: they walk through each other, and run into obstacles, where
/// they are stopped and turned back, as at the edge of the floor. Velocities are cut to the limit of speed.
class OriginalSwarm {
 public:
  struct State : Crowd {
    std::vector<Point> wanted;         ///< where each person would be by now if nothing had stopped her
    std::vector<Point> best;           ///< P_BLS, m
    std::vector<double> best_weighed;  ///< c_obj times the largest cost of an object there
    CrowdBest crowd_best;              ///< P_BGS
  };

  /// @param landscape must live as long as this
  explicit OriginalSwarm(const Landscape& landscape);

  [[nodiscard]] State begin() const;
  [[nodiscard]] double step_s() const { return landscape_->options().step_s; }
  void step(const State& now, State& next) const;

 private:
  /// c_obj times the largest cost of an object at a point.
  [[nodiscard]] double weighed_cost(std::size_t person, Point at, double at_s) const;
  void step_one(const State& now, State& next, std::size_t person, Point target) const;

  const Landscape* landscape_;
  bool knows_target_;
};
static_assert(MotionModel<OriginalSwarm>);

}  // namespace footlight::planner::swarm
