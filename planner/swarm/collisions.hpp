// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "planner/motion/crowd.hpp"

namespace footlight::planner::swarm {

/// Counts who runs into whom or what, swept: between two generations everybody goes straight, and the closest approach
/// is known in closed form. What lasts for several steps is one collision.
class Collisions {
 public:
  explicit Collisions(const MotionTask& task) : task_(&task), at_obstacle_(task.people(), 0) {}

  /// One step from `now` to `wanted`, where everybody would be if nothing stopped her. O(n log n + pairs near)
  void step(std::span<const Point> now, std::span<const Point> wanted, double from_s, double to_s);

  [[nodiscard]] std::uint64_t between_people() const { return between_people_; }
  /// With what is blocked, and with what moves.
  [[nodiscard]] std::uint64_t with_obstacles() const { return with_obstacles_; }

 private:
  [[nodiscard]] bool meets_obstacle(std::size_t person, Point from, Point to, std::span<const MotionFloor::Disc> before,
                                    std::span<const MotionFloor::Disc> after) const;

  const MotionTask* task_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> touching_;  ///< in the step before, ascending
  std::vector<char> at_obstacle_;                                  ///< in the step before, one flag a person
  std::uint64_t between_people_ = 0;
  std::uint64_t with_obstacles_ = 0;
};

}  // namespace footlight::planner::swarm
