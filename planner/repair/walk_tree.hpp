// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "planner/repair/closest_approach.hpp"

namespace footlight::planner {

/// Straight walks in a tree of boxes around their starts and around their ends, split where either of the two is
/// widest: who starts and arrives together lies together. Two branches are compared only while the difference of their
/// boxes can come within reach of zero at one moment, so that the cost follows the pairs that do come near, however far
/// people walk. Keeps its memory from use to use. Thread: one.
class WalkTree {
 public:
  enum class Pairs {
    all,
    opposed,  ///< only those with (s_a - s_b) . (g_a - g_b) < 0, whose targets may be exchanged
  };

  /// O(n log n)
  void build(std::span<const Walk> walks);
  /// People walk elsewhere: the boxes follow, the order of the tree stays. O(n)
  /// @param walks as many as were built
  void move(std::span<const Walk> walks);

  /// Pairs whose walks come nearer than `reach_m`, ascending (a, b), instead of what `found` held.
  /// @param among one flag a person: only pairs with at least one flagged person; empty: all
  void find(double reach_m, std::span<const char> among, Pairs which, std::vector<NearPair>& found);
  /// The nearest two, the first (a, b) among equals. At least two people.
  [[nodiscard]] NearPair nearest();

 private:
  /// Start x, y, end x, y.
  using Ends = std::array<double, 4>;
  struct Entry {
    Ends at;
    std::uint32_t person = 0;
    [[nodiscard]] Walk walk() const { return {{at[0], at[1]}, {at[2], at[3]}}; }
  };
  /// The entries first .. last - 1.
  struct Node {
    Ends low;
    Ends high;
    std::uint32_t first = 0;
    std::uint32_t last = 0;
    std::uint32_t right = 0;  ///< the left child is the next node; 0: a leaf
    bool wanted = true;       ///< somebody in it is flagged
  };

  std::uint32_t split(std::uint32_t first, std::uint32_t last);
  void fit_boxes();
  void flag(std::span<const char> among);
  template <class Visit>
  void join(std::uint32_t a, std::uint32_t b, const double& reach_m, Visit& visit) const;
  void sort(std::vector<NearPair>& found);
  template <class Visit>
  void compare(const Node& a, const Node& b, const double& reach_m, Visit& visit) const;

  std::vector<Entry> entries_;
  std::array<std::vector<double>, 4> column_;  ///< `at` of the entries
  std::vector<char> wanted_;                   ///< one flag an entry
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> first_of_;  ///< of each person's pairs
  std::vector<NearPair> sorted_;
};

}  // namespace footlight::planner
