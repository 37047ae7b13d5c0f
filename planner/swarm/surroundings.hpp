// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "planner/motion/neighbours.hpp"
#include "planner/swarm/landscape.hpp"

namespace footlight::planner::swarm {

/// What one generation has around it for the length of a step: people where they stand, discs where they go.
class Surroundings {
 public:
  /// Somebody near.
  struct Near {
    Point at;
    double per_scope_square = 1;  ///< 1 / (sigma_P + sigma_Q)^2, 1/m^2
    double room_m = 0;            ///< sum of both radii: what must never be come below
    std::uint32_t who = 0;
  };
  /// Something that moves, from the step's beginning to its end, and where it will be a little later.
  struct Disc {
    Point from;
    Point to;
    Point ahead;
    double radius_m = 0;
  };

  Surroundings(const Landscape& landscape, std::span<const Point> people, double from_s, double to_s);

  /// Everybody who matters to a person within this step, in the neighbours' order.
  void look(std::size_t person, std::vector<Near>& out) const;
  [[nodiscard]] const std::vector<Disc>& discs() const { return discs_; }
  /// Whether something that moves will come over a place soon, or so near that others need the place.
  [[nodiscard]] bool threatens(std::size_t person, Point at) const;
  /// |P - Q|^2 / sigma^2 of the nearest of all objects: the exponent of max Cost(P, o) in Eq. 9.
  [[nodiscard]] double nearest_squared(std::size_t person, Point at, const std::vector<Near>& near) const;

 private:
  const Landscape* landscape_;
  std::span<const Point> people_;
  Neighbours neighbours_;
  std::vector<Disc> discs_;
  double reach_m_ = 1;
};

/// Calls work(first, last) for chunks of people on all cores. What a chunk does must not depend on another.
template <class Work>
void for_people(std::size_t people, Work work) {
  constexpr std::size_t kChunk = 256;
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, people, kChunk), [&](const auto& r) { work(r.begin(), r.end()); },
      tbb::simple_partitioner());
}

}  // namespace footlight::planner::swarm
