// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "planner/repair/lateness.hpp"
#include "planner/schedule/slabs.hpp"
#include "planner/way_in.hpp"

namespace footlight::planner {

/// Everybody's walk between the first and the last beat, by shares of that time, and who is near where. Read only.
class WaysIn::Stretch {
 public:
  Stretch(const Plan& plan, std::vector<Instant> beats, double lag_s);

  [[nodiscard]] const std::vector<Instant>& beats() const { return beats_; }
  [[nodiscard]] double share_of(Instant at) const { return to_seconds(at - beats_.front()) / time_s_; }
  [[nodiscard]] double time_s() const { return time_s_; }

  /// Straight and even; from.at < to.at.
  struct Part {
    Knot from;
    Knot to;
  };
  /// Whether nobody and nothing comes too near somebody on this part of her way. O(people near)
  [[nodiscard]] bool clear(PerformerIndex who, const Part& part) const;
  /// The same against one walk of somebody's.
  [[nodiscard]] bool clear_of(PerformerIndex who, const Part& part, PerformerIndex other,
                              std::span<const Knot> walk) const;
  /// Where marks lead within the stretch; nothing when they end before it.
  [[nodiscard]] std::vector<Knot> knots_of(std::span<const Mark> marks) const;

 private:
  struct Moving {
    double radius_m = 0;
    std::vector<Knot> path;
  };
  void add_obstacles(const PlanSection& section);
  [[nodiscard]] bool clear_of_obstacles(PerformerIndex who, const Part& part) const;

  const Plan& plan_;
  std::vector<Instant> beats_;
  double time_s_;
  double late_share_;
  std::vector<double> at_;
  std::vector<std::vector<Knot>> paths_;
  std::vector<Moving> moving_;
  Slabs slabs_;
};

/// How near two people may come.
[[nodiscard]] inline double least_distance_of(const Plan& plan, PerformerIndex a, PerformerIndex b) {
  return std::max(plan.stage.clearance_m, plan.radius_m[a.at()] + plan.radius_m[b.at()]);
}

}  // namespace footlight::planner
