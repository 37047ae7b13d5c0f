// SPDX-License-Identifier: Apache-2.0
#include "planner/assignment/dense.hpp"

#include <algorithm>

namespace footlight::planner::assignment {
namespace {

/// Prices here are what is paid to a target, the other sign than outside: reduced cost = cost - value - paid.
class DenseSearch {
 public:
  DenseSearch(std::uint32_t size, std::span<const Value> costs)
      : size_(size), costs_(costs), paid_(size, 0), distance_(size), from_(size), done_(size) {
    matching_.target_of.assign(size, kNobody);
    matching_.source_of.assign(size, kNobody);
  }

  Matching solve() {
    reduce_columns();
    for (std::uint32_t source = 0; source < size_; ++source) {
      if (matching_.target_of[source] == kNobody && !augment(source)) break;
    }
    matching_.price.resize(size_);
    matching_.value.assign(size_, kFar);
    for (std::uint32_t target = 0; target < size_; ++target) matching_.price[target] = -paid_[target];
    for (std::uint32_t source = 0; source < size_; ++source) {
      const Value* row = &costs_[static_cast<std::size_t>(source) * size_];
      for (std::uint32_t target = 0; target < size_; ++target) {
        if (row[target] < kFar) {
          matching_.value[source] = std::min(matching_.value[source], row[target] - paid_[target]);
        }
      }
    }
    return std::move(matching_);
  }

 private:
  void reduce_columns() {
    std::vector<std::uint32_t> cheapest(size_, 0);
    for (std::uint32_t target = 0; target < size_; ++target) paid_[target] = costs_[target];
    for (std::uint32_t source = 1; source < size_; ++source) {
      const Value* row = &costs_[static_cast<std::size_t>(source) * size_];
      for (std::uint32_t target = 0; target < size_; ++target) {
        if (row[target] < paid_[target]) {
          paid_[target] = row[target];
          cheapest[target] = source;
        }
      }
    }
    for (std::uint32_t target = size_; target-- > 0;) {
      if (paid_[target] >= kFar) {
        paid_[target] = 0;
      } else if (matching_.target_of[cheapest[target]] == kNobody) {
        match(cheapest[target], target);
      }
    }
  }

  void match(std::uint32_t source, std::uint32_t target) {
    matching_.target_of[source] = target;
    matching_.source_of[target] = source;
  }

  /// Dijkstra's search from one free source over the targets; distances count from the source's least reduced cost.
  bool augment(std::uint32_t start) {
    const Value* row = &costs_[static_cast<std::size_t>(start) * size_];
    for (std::uint32_t target = 0; target < size_; ++target) {
      distance_[target] = row[target] < kFar ? row[target] - paid_[target] : kFar;
    }
    std::ranges::fill(from_, start);
    std::ranges::fill(done_, 0);
    while (true) {
      std::uint32_t nearest = kNobody;
      Value least = kFar;
      for (std::uint32_t target = 0; target < size_; ++target) {
        if (done_[target] == 0 && distance_[target] < least) {
          least = distance_[target];
          nearest = target;
        }
      }
      if (nearest == kNobody) return false;
      done_[nearest] = 1;
      if (matching_.source_of[nearest] == kNobody) {
        apply(start, nearest);
        return true;
      }
      relax(matching_.source_of[nearest], nearest);
    }
  }

  void relax(std::uint32_t source, std::uint32_t reached) {
    const Value* row = &costs_[static_cast<std::size_t>(source) * size_];
    const Value base = distance_[reached] - (row[reached] - paid_[reached]);
    for (std::uint32_t target = 0; target < size_; ++target) {
      const Value through = base + row[target] - paid_[target];
      if (row[target] < kFar && done_[target] == 0 && through < distance_[target]) {
        distance_[target] = through;
        from_[target] = source;
      }
    }
  }

  void apply(std::uint32_t start, std::uint32_t end) {
    for (std::uint32_t target = 0; target < size_; ++target) {
      if (done_[target] != 0) paid_[target] += distance_[target] - distance_[end];
    }
    for (std::uint32_t target = end;;) {
      const std::uint32_t source = from_[target];
      const std::uint32_t before = matching_.target_of[source];
      match(source, target);
      if (source == start) return;
      target = before;
    }
  }

  std::uint32_t size_;
  std::span<const Value> costs_;
  std::vector<Value> paid_;
  std::vector<Value> distance_;
  std::vector<std::uint32_t> from_;
  std::vector<std::uint8_t> done_;
  Matching matching_;
};

}  // namespace

Matching match_dense(std::uint32_t size, std::span<const Value> costs) { return DenseSearch(size, costs).solve(); }

}  // namespace footlight::planner::assignment
