// SPDX-License-Identifier: Apache-2.0
#include "planner/assignment/dense.hpp"

#include <algorithm>
#include <limits>

#include "planner/assignment/kernels.hpp"

namespace footlight::planner::assignment {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Of targets that are equally far a free one ends the search. Distances are whole numbers.
constexpr double kFreeFirst = -0.25;

/// Prices here are what is paid to a target, the other sign than outside: reduced cost = cost - value - paid.
class DenseSearch {
 public:
  explicit DenseSearch(const CostTable& costs)
      : costs_(costs),
        size_(costs.size()),
        relax_(kernels().relax),
        paid_(costs.width(), 0),
        distance_(costs.width()),
        from_(costs.width()),
        rank_(costs.width()) {
    matching_.target_of.assign(size_, kNobody);
    matching_.source_of.assign(size_, kNobody);
  }

  Matching solve() {
    reduce_columns();
    for (std::uint32_t source = 0; source < size_; ++source) {
      if (matching_.target_of[source] == kNobody && !augment(source)) break;
    }
    matching_.price.resize(size_);
    matching_.value.assign(size_, kFar);
    for (std::uint32_t target = 0; target < size_; ++target) {
      matching_.price[target] = -static_cast<Value>(paid_[target]);
    }
    for (std::uint32_t source = 0; source < size_; ++source) {
      const double* row = costs_.row(source);
      double least = kInfinity;
      for (std::uint32_t target = 0; target < size_; ++target) least = std::min(least, row[target] - paid_[target]);
      if (least < kInfinity) matching_.value[source] = static_cast<Value>(least);
    }
    return std::move(matching_);
  }

 private:
  void reduce_columns() {
    std::vector<double> cheapest(costs_.width(), 0);
    std::copy_n(costs_.row(0), costs_.width(), paid_.begin());
    for (std::uint32_t source = 1; source < size_; ++source) {
      const double* row = costs_.row(source);
      const auto number = static_cast<double>(source);
      for (std::uint32_t target = 0; target < costs_.width(); ++target) {
        const bool less = row[target] < paid_[target];
        cheapest[target] = less ? number : cheapest[target];
        paid_[target] = less ? row[target] : paid_[target];
      }
    }
    for (std::uint32_t target = costs_.width(); target-- > 0;) {
      const auto source = static_cast<std::uint32_t>(cheapest[target]);
      if (!(paid_[target] < kInfinity)) {
        paid_[target] = 0;
      } else if (matching_.target_of[source] == kNobody) {
        match(source, target);
      }
    }
  }

  void match(std::uint32_t source, std::uint32_t target) {
    matching_.target_of[source] = target;
    matching_.source_of[target] = source;
  }

  /// Dijkstra's search from one free source over the targets; distances count from the source's least reduced cost.
  bool augment(std::uint32_t start) {
    std::ranges::fill(distance_, kInfinity);
    for (std::uint32_t target = 0; target < size_; ++target) {
      rank_[target] = matching_.source_of[target] == kNobody ? kFreeFirst : 0;
    }
    std::uint32_t source = start;
    double base = 0;
    while (true) {
      const std::uint32_t nearest = relax_(costs_.row(source), paid_.data(), rank_.data(), base, source, costs_.width(),
                                           distance_.data(), from_.data());
      if (!(distance_[nearest] + rank_[nearest] < kInfinity)) return false;
      rank_[nearest] = kInfinity;
      source = matching_.source_of[nearest];
      if (source == kNobody) {
        apply(start, nearest);
        return true;
      }
      base = distance_[nearest] - (costs_.row(source)[nearest] - paid_[nearest]);
    }
  }

  void apply(std::uint32_t start, std::uint32_t end) {
    for (std::uint32_t target = 0; target < size_; ++target) {
      if (rank_[target] == kInfinity) paid_[target] += distance_[target] - distance_[end];
    }
    for (std::uint32_t target = end;;) {
      const auto source = static_cast<std::uint32_t>(from_[target]);
      const std::uint32_t before = matching_.target_of[source];
      match(source, target);
      if (source == start) return;
      target = before;
    }
  }

  const CostTable& costs_;
  std::uint32_t size_;
  decltype(Kernels::relax) relax_;
  std::vector<double> paid_, distance_, from_;
  std::vector<double> rank_;  ///< kFreeFirst or 0: open, infinity: the search has been there
  Matching matching_;
};

}  // namespace

CostTable::CostTable(std::uint32_t size)
    : size_(size), width_((size + kFan - 1) / kFan * kFan), costs_(std::size_t{size_} * width_, kInfinity) {}

Matching match_dense(const CostTable& costs) { return DenseSearch(costs).solve(); }

}  // namespace footlight::planner::assignment
