// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/grid.hpp"
#include "planner/assignment/arc_rows.hpp"
#include "planner/assignment/assignment.hpp"

namespace footlight::planner::assignment {

/// A common lattice of points: x = first.x + i step_x, y = first.y + j step_y, and step_x^2 : step_y^2 = weight_x :
/// weight_y in small integers. The centres of square (1 : 1), hexagonal (1 : 3) and triangular (3 : 1) grids have one.
struct Lattice {
  double step_x = 0;
  double step_y = 0;
  int weight_x = 1;
  int weight_y = 1;
  double unit = 1;  ///< m^2 of one unit of weight_x i^2 + weight_y j^2
};

/// @return the lattice that holds all sources and, perhaps displaced, all targets within 1e-7 of a step; nothing when
/// there is none of fewer than 2^22 steps. O(N)
[[nodiscard]] std::optional<Lattice> find_lattice(std::span<const Point> sources, std::span<const Point> targets);

/// N sources and N targets in kd order and the integer costs of the walks between them.
///
/// Squared walks between points of a lattice are integers by nature: weight_x i^2 + weight_y j^2. Moving all targets
/// together changes every assignment's squared cost by the same amount, so that both sides are centred first. All
/// other costs are rounded once to multiples of 2^-k of a metre (m^2), k as large as N x the longest walk < 2^58
/// allows, at most 2^46 for the longest.
class Walks {
 public:
  Walks(std::span<const Point> sources, std::span<const Point> targets, WalkCost metric, double longest_m);

  /// The means of each four points of one side that follow each other in kd order: the same formations, drawn with
  /// half as many points each way. A longest walk becomes longer by half of what two neighbours are apart here.
  [[nodiscard]] Walks fours() const;
  /// The same without a longest walk.
  [[nodiscard]] Walks unlimited() const;

  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(sources_.x.size()); }
  [[nodiscard]] WalkCost metric() const { return metric_; }

  [[nodiscard]] Value cost(std::uint32_t source, std::uint32_t target) const {
    const double dx = sources_.x[source] - targets_.x[target];
    const double dy = sources_.y[source] - targets_.y[target];
    return to_value(weight_x_ * dx * dx + weight_y_ * dy * dy);
  }
  /// Not longer than longest_m, judged by the given points; of fours by their means.
  [[nodiscard]] bool allowed(std::uint32_t source, std::uint32_t target) const;
  [[nodiscard]] bool limited() const;

  /// One side of it for searches in single precision: costs there are cost() / scale().
  struct Side {
    std::vector<double> x, y;
    std::vector<float> search_x, search_y;
    std::vector<std::uint32_t> original;  ///< index in the span that was given
  };
  [[nodiscard]] const Side& sources() const { return sources_; }
  [[nodiscard]] const Side& targets() const { return targets_; }
  [[nodiscard]] double scale() const { return scale_; }
  /// Longest walk in coordinates of the searches.
  [[nodiscard]] float reach() const { return reach_; }
  /// m or m^2 of a cost of 1.
  [[nodiscard]] double unit() const { return unit_; }
  /// True when cost() is the squared walk itself, not a rounded one (but for a displacement).
  [[nodiscard]] bool on_lattice() const { return on_lattice_; }
  /// What the targets were moved by before costs were taken, m.
  [[nodiscard]] Point shift() const { return shift_; }
  /// About the cost of a walk to the next neighbour among the targets.
  [[nodiscard]] Value spacing() const { return spacing_; }

 private:
  Walks() = default;
  [[nodiscard]] Value to_value(double squared) const;
  void measure_spacing();

  WalkCost metric_ = WalkCost::squared;
  std::span<const Point> source_points_, target_points_;
  double longest_m_ = 0;
  Side sources_, targets_;
  double weight_x_ = 1;
  double weight_y_ = 1;
  double scale_ = 1;
  double unit_ = 1;
  float reach_ = 0;
  bool on_lattice_ = false;
  Point shift_;
  Value spacing_ = 1;
};

}  // namespace footlight::planner::assignment
