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

/// What one generation has around it for the length of a step: people where they stand, discs where they go. Keeps its
/// memory from step to step. People are in the order of the bins that they are sorted into: who is near in space is
/// near in memory, too. A rank is a place in that order.
class Surroundings {
 public:
  /// Somebody near.
  struct Near {
    Point away;                   ///< to her, from who looks
    double per_scope_square = 1;  ///< 1 / (sigma_P + sigma_Q)^2, 1/m^2
    double keep_square = 0;  ///< squared distance that a step must keep: of both radii, or of now where that is less
    std::uint32_t rank = 0;
  };
  /// Something that moves, from the step's beginning to its end, and where it will be a little later.
  struct Disc {
    Point from;
    Point to;
    Point ahead;
    double radius_m = 0;
  };

  /// O(people)
  void sort(const Landscape& landscape, std::span<const Point> people, double from_s, double to_s);

  /// Numbers of people by rank, and where they stand.
  [[nodiscard]] std::span<const std::uint32_t> order() const { return neighbours_.order(); }
  [[nodiscard]] std::span<const Point> places() const { return neighbours_.places(); }
  [[nodiscard]] double radius_m(std::size_t rank) const { return radius_m_[rank]; }

  /// Everybody who matters to a person within this step, in the neighbours' order.
  void look(std::size_t rank, std::vector<Near>& out) const;
  /// Calls visit(rank) for everybody, and others, whom a person may touch in this step if both walk.
  template <class Visit>
  void visit_touching(std::size_t rank, Visit visit) const {
    neighbours_.visit_rows(places()[rank], touch_m_, [&](std::uint32_t begin, std::uint32_t end) {
      for (std::uint32_t other = begin; other < end; ++other) {
        if (other != rank) visit(other);
      }
    });
  }
  [[nodiscard]] const std::vector<Disc>& discs() const { return discs_; }
  /// Whether something that moves will come over a place soon, or so near that others need the place.
  [[nodiscard]] bool threatens(std::size_t person, Point at) const;
  /// |P - Q|^2 / sigma^2 of the nearest place that something that moves will come over, or `beyond` where that is more.
  [[nodiscard]] double disc_squared(std::size_t person, Point at, double beyond) const;

 private:
  const Landscape* landscape_ = nullptr;
  Neighbours neighbours_;
  std::vector<double> scope_m_;   ///< by rank
  std::vector<double> radius_m_;  ///< by rank
  std::vector<Disc> discs_;
  double reach_m_ = 1;
  double touch_m_ = 1;
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
