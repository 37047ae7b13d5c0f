// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "planner/assignment/arc_rows.hpp"

namespace footlight::planner::assignment {

/// The Hungarian method in phases: one Dijkstra search from all free sources at once, a change of prices by the
/// (truncated) distances, then as many disjoint augmenting paths over tight arcs as a depth-first search finds (as in
/// Hopcroft and Karp 1973; Gabow and Tarjan 1989). Keeps cost + price - value >= 0 on all arcs and = 0 on matched
/// ones, so that a perfect matching is a cheapest one of the rows.
class Phases {
 public:
  /// @param small_costs distances are small integers, for which the queue is an array of buckets (Dial 1969); else, and
  /// when they turn out not to be small, it is a heap
  Phases(ArcRows& rows, Matching& matching, bool small_costs);

  enum class Outcome : std::uint8_t {
    perfect,
    stuck,     ///< the sources in reached_sources() have arcs to fewer targets than they are
    given_up,  ///< out of patience
  };

  /// From any prices and matching to a state that satisfies the invariant: least prices, and of the matching what is
  /// tight. O(arcs)
  void tighten();

  [[nodiscard]] Outcome run(const Patience& patience);

  /// Arcs that all searches have looked at.
  [[nodiscard]] std::uint64_t looked_at() const { return looked_at_; }

  /// After run() returned `stuck`.
  [[nodiscard]] std::span<const std::uint32_t> reached_sources() const { return reached_sources_; }
  [[nodiscard]] std::span<const std::uint32_t> reached_targets() const { return reached_targets_; }

  /// Takes more arcs in, sorted by source; who is no longer matched tightly becomes free.
  void add(std::span<const ArcRows::NewArc> arcs);

 private:
  struct Search {
    bool found = false;
    Value farthest = 0;
  };
  [[nodiscard]] Search search(std::size_t wanted);
  [[nodiscard]] Search explore(std::size_t wanted);
  void relax(std::uint32_t source, Value base);
  void push(std::uint32_t node, Value distance);
  std::uint32_t pop();
  void forget();
  void change_prices(Value farthest);
  std::size_t augment();
  bool augment_from(std::uint32_t start);
  void collect_free();
  [[nodiscard]] Value reduced(std::uint32_t source, std::uint32_t arc) const {
    return rows_.cost[arc] + matching_.price[rows_.target[arc]] - matching_.value[source];
  }

  static constexpr std::size_t kBuckets = 2048;

  ArcRows& rows_;
  Matching& matching_;
  bool by_heap_;
  std::vector<std::vector<std::uint32_t>> buckets_;
  std::vector<std::pair<Value, std::uint32_t>> heap_;
  Value now_ = 0;  ///< distance that the search has come to
  std::size_t queued_ = 0;
  Value dropped_ = kFar;  ///< least of the distances that fell out of the queue's window
  std::uint64_t looked_at_ = 0;
  std::vector<Value> source_distance_, target_distance_, source_done_;
  std::vector<std::uint32_t> reached_sources_, reached_targets_, free_;
  std::vector<std::uint32_t> next_arc_, path_;
  std::vector<std::uint8_t> visited_;
};

}  // namespace footlight::planner::assignment
