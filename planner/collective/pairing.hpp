// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/grid.hpp"
#include "core/motion/collective_options.hpp"
#include "planner/collective/walk_field.hpp"

namespace footlight::planner::collective {

/// Mean length of the Delaunay edges at each point, m: delta of Eq. 4 and 5. Where points of a lattice lie on one
/// circle their triangulation is arbitrary; the edges that are are left out, so that equal surroundings have equal
/// deltas. 0 for a point without neighbours.
[[nodiscard]] std::vector<double> mean_edges_m(std::span<const Point> points);

/// People and places of one group.
struct PairingTask {
  std::span<const Point> from;        ///< of each person
  std::span<const Point> to;          ///< as many
  std::span<const double> radius_m;   ///< of each person, > 0
  std::span<const double> speed_mps;  ///< of each person, > 0
  const WalkField* around = nullptr;  ///< ways around what is blocked; nothing: the floor is open
  const std::atomic<bool>* stop = nullptr;
};

/// What it costs each person to take each place, Eq. 3 or the two others of section 5.2:
///
///   least effort   lambda |st|^2 + (1 - lambda) |delta_s - delta_t|^2
///   Euclidean      |st|
///   Manhattan      |x_s - x_t| + |y_s - y_t|
/// |st| is the length of the shortest walkable way, times how much slower than the fastest she walks. Who is wider than
/// a place's surroundings are far apart is not the one for it: (1 - lambda) max(0, 2 radius - delta_t)^2 more in least
/// effort. Manhattan distances grow by as much as the way around grows over the straight one.
class PairCosts {
 public:
  /// With ways around what is blocked: O(places cells log cells), in parallel, and a table of people x places.
  PairCosts(const PairingTask& task, const CollectiveOptions& options);

  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(from_.size()); }
  /// Infinity: there is no way.
  [[nodiscard]] double cost(std::uint32_t person, std::uint32_t place) const {
    return cost_of(person, place, from_[person], to_[place]);
  }
  /// The same with both formations laid on each other: what is likely to be cheap in the cheapest pairing.
  [[nodiscard]] double cost_of_shape(std::uint32_t person, std::uint32_t place) const {
    return cost_of(person, place, from_[person] - shift_, to_[place]);
  }

 private:
  [[nodiscard]] double cost_of(std::uint32_t person, std::uint32_t place, Point from, Point to) const;

  std::vector<Point> from_, to_;
  std::vector<double> slowness_, radius_m_, from_edges_m_, to_edges_m_;
  std::vector<float> stretch_;  ///< of the way around against the straight one, person by person; empty: open floor
  CollectiveOptions::Pairing kind_;
  double lambda_;
  Point shift_;
};

/// Largest number of people in one group whose ways around what is blocked are looked at; more are paired by straight
/// distances.
inline constexpr std::size_t kMostAround = 5000;

struct Pairing {
  std::vector<std::uint32_t> place_of;  ///< of each person
  double cost = 0;                      ///< Eq. 6
  double gap = 0;   ///< above the value of a dual solution that holds for all pairs: 0 but for rounding
  int widened = 0;  ///< times that pairs had to be added
};

/// The cheapest pairing, Eq. 6, exact: the paper's Kuhn and Munkres over a few likely pairs each, to which all pairs
/// are added that the dual solution finds too cheap, until it finds none: then it proves all pairs.
/// @return nothing when no pairing without an infinite cost exists, or when stopped
/// Complexity: O(people^2) a round, in parallel, and the matching. Deterministic. Thread: reentrant.
[[nodiscard]] std::optional<Pairing> find_pairing(const PairCosts& costs, const std::atomic<bool>* stop);

}  // namespace footlight::planner::collective
