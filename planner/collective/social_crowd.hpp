// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/motion/collective_options.hpp"
#include "planner/collective/social_force.hpp"
#include "planner/collective/timed_ways.hpp"
#include "planner/motion/crowd.hpp"
#include "planner/motion/model.hpp"
#include "planner/motion/neighbours.hpp"
#include "planner/motion/spare.hpp"
#include "planner/mutual_information.hpp"

namespace footlight::planner::collective {

/// The movement of Xu 2015, sections 3.3 and 3.5: a social force model with sub-groups and the feedback of mutual
/// information, Eq. 7 to 23.
///
/// The ideal heading e of Eq. 8 goes to the next corner of her timed way, the wanted speed v0 is what brings her there
/// in time; so that people of different ways arrive together.
class SocialCrowd {
 public:
  struct State : Crowd {
    std::vector<std::uint32_t> next_corner;  ///< of her timed way
    PlaceInformation information{};          ///< I_d and I_v of the step's beginning
  };

  /// @param subgroup of each person, 0..; empty: there are none  @param task, ways must live as long
  SocialCrowd(const MotionTask& task, const CollectiveOptions& options, const TimedWays& ways,
              std::vector<std::uint32_t> subgroup);

  [[nodiscard]] State begin() const;
  [[nodiscard]] double step_s() const { return 0.1; }
  void step(const State& now, State& next) const;

 private:
  /// What somebody wants before forces: Eq. 8's e and v0.
  struct Wish {
    Point heading;
    double speed_mps = 0;
  };
  /// What is found out in a step; forgotten after it.
  struct Scratch {
    std::vector<Wish> wish;
    std::vector<WalkClasses> classes;
    Neighbours near;
    std::vector<double> radius_m;         ///< in the order of `near`
    std::vector<std::uint32_t> subgroup;  ///< in the order of `near`
    std::vector<Point> own;               ///< Eq. 10 of those of her sub-group, m/s^2
    std::vector<Point> strangers;         ///< Eq. 10 and 22 of all others
    std::vector<Point> off;               ///< see `find_missing`
    std::vector<Point> sum;               ///< of each sub-group
  };
  [[nodiscard]] std::uint32_t corner_of(const State& now, std::size_t person, double at_s) const;
  [[nodiscard]] Wish wish(std::uint32_t corner, std::size_t person, Point at, double limit_mps, double at_s) const;
  [[nodiscard]] double limit_mps(std::size_t person, Point at) const {
    return task_.speed_mps[person] * task_.floor->speed_factor(at);
  }
  void make_wishes(const State& now, State& next, double at_s, Scratch& scratch) const;
  void feed_back(const State& now, const PlaceInformation& information, Scratch& scratch) const;
  void find_pushes(const State& now, Scratch& scratch) const;
  void share_pushes(Scratch& scratch) const;
  void find_missing(const State& now, double at_s, Scratch& scratch) const;
  [[nodiscard]] Point obstacles(std::size_t person, Point at, bool near_blocked,
                                const std::vector<MotionFloor::Disc>& discs) const;
  [[nodiscard]] Point moved(std::size_t person, Point from, Point by, bool near_blocked,
                            const std::vector<MotionFloor::Disc>& discs) const;
  [[nodiscard]] bool near_blocked(Point at) const {
    return !near_blocked_.empty() && near_blocked_[task_.floor->ways().grid().nearest(at).at()] != 0;
  }

  const MotionTask& task_;
  CollectiveOptions options_;
  const TimedWays& ways_;
  std::vector<std::uint32_t> subgroup_;
  InformationClasses classes_;
  Falloff repulsion_, separation_, cohesion_;
  double look_m_ = 1;               ///< within which others are felt
  std::vector<char> near_blocked_;  ///< cells from which something blocked is felt; empty: nothing is blocked
  std::vector<double> subgroup_people_;
  Spare<Scratch> scratch_;
};

}  // namespace footlight::planner::collective
