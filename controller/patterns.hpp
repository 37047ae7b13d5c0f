// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/index.hpp"

namespace footlight::controller {

/// Who could take whose lamp for the own one, and how often: for each pair and moment at which both goals were lit with
/// the same look no more than 1.5 pitches apart, one.
class NearGoals {
 public:
  explicit NearGoals(std::size_t performers) : performers_(performers) {}
  /// @param a, b different performers, in any order
  void add(PerformerIndex a, PerformerIndex b);
  /// One pattern out of `patterns` for each performer, for the whole show, so that few near pairs share one: greedy,
  /// heaviest performers first, then sweeps that change one performer at a time while that helps. Deterministic.
  /// O(P log P + E) for each of at most 9 passes over E different pairs.
  [[nodiscard]] std::vector<std::uint8_t> patterns(int patterns);

 private:
  struct Pair {
    std::uint64_t key = 0;  ///< lower performer in the high half
    std::uint32_t weight = 0;
  };
  void fold();

  std::size_t performers_;
  std::vector<Pair> pairs_;         ///< ascending, folded
  std::vector<std::uint64_t> raw_;  ///< not folded yet
};

}  // namespace footlight::controller
