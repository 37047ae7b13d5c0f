// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace footlight::planner::assignment {

/// Costs and prices inside of the assignment are integers, so that nothing is ever "nearly" tight. How a cost in
/// metres becomes one is the business of Walks and assign_sparse.
using Value = std::int64_t;

/// Above every cost, price and path; two of them can be added.
inline constexpr Value kFar = std::numeric_limits<Value>::max() / 4;
inline constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();

/// The nearest integer of a number in [0, 2^52), halves up. Truncation is one instruction everywhere, std::llround a
/// call.
[[nodiscard]] inline Value nearest_value(double number) {
  constexpr double kHalf = 0.5;
  return static_cast<Value>(number + kHalf);
}

/// Allowed pairs, row by row of their sources.
struct ArcRows {
  std::vector<std::uint32_t> first{0};  ///< size + 1; row i is [first[i], first[i + 1])
  std::vector<std::uint32_t> target;
  std::vector<Value> cost;

  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(first.size()) - 1; }
  void add(std::uint32_t to, Value walk) {
    target.push_back(to);
    cost.push_back(walk);
  }
  void close_row() { first.push_back(static_cast<std::uint32_t>(target.size())); }

  struct NewArc {
    std::uint32_t source;
    std::uint32_t target;
    Value cost;
  };
  /// @param arcs sorted by source, none of them here already. O(all arcs)
  void merge(std::span<const NewArc> arcs);
};

/// A matching, perhaps not perfect, and prices: source i would like the target with the least cost + price.
struct Matching {
  std::vector<std::uint32_t> target_of;  ///< kNobody: free
  std::vector<std::uint32_t> source_of;  ///< kNobody: free
  std::vector<Value> price;              ///< of a target
  std::vector<Value> value;              ///< of a source: its least cost + price, where it has been found
  std::uint64_t looked_at = 0;           ///< arcs that the exact method has looked at
};

/// When an exact method gives up.
struct Patience {
  std::uint64_t most_arcs = std::numeric_limits<std::uint64_t>::max();  ///< to look at
  const std::atomic<bool>* stop = nullptr;                              ///< becomes true when nobody wants the answer

  [[nodiscard]] bool over(std::uint64_t looked_at) const {
    return looked_at > most_arcs || (stop != nullptr && stop->load(std::memory_order_relaxed));
  }
};

}  // namespace footlight::planner::assignment
