// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "core/grid.hpp"
#include "planner/repair/lateness.hpp"

namespace footlight::planner {

/// Who is where in each stretch of time: people in square buckets by where they are in its middle. The buckets of a
/// stretch are filled when it is first looked at.
class Slabs {
 public:
  /// @param at where the stretches begin and the last one ends, ascending shares of the time; must outlive it
  /// @param paths from share 0 to share 1; must outlive it
  /// @param keep_m no two people keep more  @param late_share how late anybody may be, a share of the time
  /// @param fastest_m nobody walks further in the whole time
  Slabs(const Grid& grid, std::span<const double> at, const std::vector<std::vector<Knot>>& paths, double keep_m,
        double late_share, double fastest_m);

  /// Calls visit(person) for everybody who may come too near in a stretch to somebody who is at a point in its middle.
  /// @param walk_m she walks that far in the whole time at her speed in this stretch
  template <class Visit>
  void visit_near(std::size_t slab, Point at, double walk_m, Visit visit) {
    fill(slab);
    visit_filled(slab, at, walk_m, visit);
  }
  /// The same of a stretch whose buckets are filled; many threads may look at once.
  template <class Visit>
  void visit_filled(std::size_t slab, Point at, double walk_m, Visit visit) const {
    const double own_m = keep_m_ + walk_m * moving_share(slab);
    const double most_m = own_m + fastest_m_ * moving_share(slab);
    const int last_row = row(at.y + most_m);
    const int last_column = column(at.x + most_m);
    for (int r = row(at.y - most_m); r <= last_row; ++r) {
      for (int c = column(at.x - most_m); c <= last_column; ++c) {
        for (const Entry& entry : slabs_[slab][bucket(c, r)]) {
          const double reach_m = own_m + entry.reach_m;
          if (squared_length(entry.at - at) < reach_m * reach_m) visit(entry.person);
        }
      }
    }
  }
  void fill_all() {
    for (std::size_t slab = 0; slab < slabs_.size(); ++slab) fill(slab);
  }

  /// Everybody who may be met on a way, ascending.
  [[nodiscard]] std::vector<std::uint32_t> near(std::span<const Knot> path);

  /// @param path hers as it is before she is given another one, which is then added
  void remove(std::uint32_t person, std::span<const Knot> path);
  void add(std::uint32_t person, std::span<const Knot> path);

 private:
  struct Entry {
    std::uint32_t person = 0;
    Point at;
    double reach_m = 0;  ///< so far away she is at most in the stretch, late or not
  };
  using Buckets = std::vector<std::vector<Entry>>;

  void fill(std::size_t slab);
  void put(std::size_t slab, std::uint32_t person, std::span<const Knot> path);
  [[nodiscard]] Point in_the_middle_of(std::size_t slab, std::span<const Knot> path) const;
  /// From the middle of a stretch to its ends and as late as anybody may be, a share of the time.
  [[nodiscard]] double moving_share(std::size_t slab) const { return (at_[slab + 1] - at_[slab]) / 2 + late_share_; }
  [[nodiscard]] int column(double x) const { return clamped((x - low_.x) / side_m_, columns_); }
  [[nodiscard]] int row(double y) const { return clamped((y - low_.y) / side_m_, rows_); }
  [[nodiscard]] static int clamped(double at, int size) {
    return static_cast<int>(std::clamp(at, 0.0, static_cast<double>(size - 1)));
  }
  [[nodiscard]] std::size_t bucket(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  }
  [[nodiscard]] std::size_t bucket(Point at) const { return bucket(column(at.x), row(at.y)); }

  std::span<const double> at_;
  const std::vector<std::vector<Knot>>& paths_;
  double keep_m_;
  double late_share_;
  double fastest_m_;
  Point low_;
  double side_m_ = 1;
  int columns_ = 1;
  int rows_ = 1;
  std::vector<Buckets> slabs_;  ///< empty: not yet filled
};

}  // namespace footlight::planner
