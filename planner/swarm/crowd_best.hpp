// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "planner/swarm/landscape.hpp"

namespace footlight::planner::swarm {

/// P_BGS of each crowd: the best that anybody of it has found so far. Each person has a place of her own, so it is kept
/// as its offset from the place of who found it, and seen from one's own place.
struct CrowdBest {
  std::vector<Point> offset;    ///< of each crowd, m
  std::vector<double> weighed;  ///< c_obj times the largest cost of an object there

  explicit CrowdBest(std::size_t crowds = 0)
      : offset(crowds), weighed(crowds, std::numeric_limits<double>::infinity()) {}

  /// Takes what is better by Eq. 9 among what each person has found herself. The first of equals.
  /// @param best, best_weighed P_BLS of each person, and c_obj times the largest cost of an object there  @param place
  /// of each person  @param shifts as Landscape::shifts
  void improve(const Landscape& landscape, std::span<const Point> best, std::span<const double> best_weighed,
               std::span<const std::uint32_t> place, std::span<const Point> shifts);
};

}  // namespace footlight::planner::swarm
