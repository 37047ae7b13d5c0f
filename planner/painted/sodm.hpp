// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "planner/painted/raster.hpp"

namespace footlight::planner {

/// The lattice of a map: who is whose neighbour. Rows of nearly equal length, so that it holds any number of people.
class Lattice {
 public:
  /// @param people > 0  @param aspect width over height that is wanted, > 0
  Lattice(int people, double aspect);

  [[nodiscard]] int people() const { return static_cast<int>(at_.size()); }
  [[nodiscard]] int rows() const { return rows_; }
  /// Place on the lattice, neighbours about 1 apart, the first at (1/2, 1/2).
  [[nodiscard]] const std::vector<Point>& places() const { return at_; }
  [[nodiscard]] double width() const { return width_; }
  /// Everybody and the next in the row, everybody and the nearest in the next row; each pair once.
  [[nodiscard]] const std::vector<std::pair<int, int>>& neighbours() const { return neighbours_; }

 private:
  int rows_ = 1;
  double width_ = 1;
  std::vector<Point> at_;
  std::vector<std::pair<int, int>> neighbours_;
};

/// One of the eight ways in which a lattice lies on a shape at first: as it is, or its rows as columns, then mirrored.
struct LatticeTurn {
  bool transposed = false;
  bool mirrored_x = false;
  bool mirrored_y = false;
};
/// A lattice spread evenly over a shape's bounding box, pixels.
[[nodiscard]] std::vector<Point> spread_over(const PixelSet& shape, const Lattice& lattice, LatticeTurn turn);

struct SodmTask {
  const PixelSet* shape = nullptr;  ///< at least one pixel
  const Lattice* lattice = nullptr;
  int iterations = 3000;  ///< inputs shown, at least; 20 for each neuron are the fewest
  std::uint64_t seed = 1;
  bool fit_shape = true;   ///< v_a of Eq. 1-2; without it and the next it is a plain self-organising map
  bool keep_apart = true;  ///< v_d of Eq. 1
  LatticeTurn turn{};      ///< how the map lies at first; it stays so
};

/// Places for people in a painted shape: a self-organising map with distance.
///
/// Source: Kang, Kim 2014, Eq. 1: w(t+1) = w(t) + theta(v,t) eta(t) (D(t) - w(t)) + v_a(t) + v_d(t), and Eq. 2: v_a(t)
/// = alpha(t) theta_a(v,t) eta_a(t) (N(t) - w(t)), alpha 0 within the shape and 1 outside. theta is Gaussian over the
/// lattice distance to the best matching neuron, its width falling from half of the lattice to half a neuron; eta falls
/// linearly, theta_a rises linearly. The paper does not print v_d: here two neurons nearer than d push each other apart
/// by half of what is missing, with a weight that rises as theta_a; d is the distance at which so many points fill the
/// shape's area as a triangular lattice. After the inputs the two forces go on until nobody moves more than d/100 (at
/// most 500 rounds).
/// @return for each place of the lattice a point in the shape, pixels; with both forces all inside of it. Deterministic
/// for a seed. O(inputs x people)
[[nodiscard]] std::vector<Point> sodm(const SodmTask& task);

/// Distance at which `people` points fill the shape as a triangular lattice, pixels.
[[nodiscard]] double ideal_spacing(const PixelSet& shape, int people);

/// The paper's figure 3 in numbers.
struct MapQuality {
  double neighbours_kept = 0;  ///< share of lattice neighbours no farther than 1.5 ideal spacings from each other
  double separation = 0;       ///< least distance of two people over the ideal spacing
  double coverage = 0;         ///< share of the shape's pixels within one ideal spacing's circumradius of somebody
  double inside = 0;           ///< share of people in the shape
};
[[nodiscard]] MapQuality quality(const PixelSet& shape, const Lattice& lattice, const std::vector<Point>& places);

}  // namespace footlight::planner
