// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/grid.hpp"
#include "planner/motion/neighbours.hpp"

namespace footlight::planner::srd {

/// What a step works with (planner/srd/srd_step.hpp). People are in the order of the bins that they stand in: who is
/// near whom is near in memory, so that a step of many people costs each as much as one of few.
struct StepMemory {
  /// Of the people of one chunk.
  struct Chunk {
    std::vector<std::uint32_t> begin;  ///< of each of its people in `near`; one more
    std::vector<std::uint32_t> near;   ///< who may be met within this step
  };

  Neighbours crowd;  ///< of where people stand now
  std::vector<double> radius_m;
  std::vector<double> pace_mps;  ///< the fastest that each person can go on her ground
  std::vector<std::int32_t> group;
  std::vector<char> released;
  std::vector<Point> destination;      ///< where each person wants to be at the end of the step
  std::vector<Point> destination_mps;  ///< how that moves
  std::vector<Point> predicted;        ///< p*
  std::vector<Point> other;            ///< the next p*, while it is worked out
  /// Where people are and how they mean to move, for whom others will meet.
  /// @{
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> x_mps;
  std::vector<double> y_mps;
  /// @}
  std::vector<Chunk> chunks;
};

}  // namespace footlight::planner::srd
