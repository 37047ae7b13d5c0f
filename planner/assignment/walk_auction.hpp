// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "planner/assignment/price_tree.hpp"
#include "planner/assignment/walks.hpp"

namespace footlight::planner::assignment {

/// Bertsekas' auction (1988) among walkers, in single precision: good prices and a nearly cheapest matching for the
/// exact method to finish.
///
/// Each source keeps a short list of its best targets and a horizon, below which no target outside of the list can be,
/// since prices only rise. It bids from the list, a few nanoseconds, and asks the tree again only when its best is
/// beyond the horizon.
class WalkAuction {
 public:
  /// @param tree fitted with the prices to start from
  WalkAuction(const Walks& walks, PriceTree& tree, float margin);

  /// All start free and bid, the last displaced first. @param step everybody ends within it of the best
  /// @return false when the bids were used up before all had a target
  bool hold(float step, std::uint64_t most_bids);

  [[nodiscard]] const std::vector<std::uint32_t>& target_of() const { return target_of_; }
  [[nodiscard]] const std::vector<std::uint32_t>& source_of() const { return source_of_; }

 private:
  /// A source's best targets, filled up to a full fan with some that are infinitely far.
  struct List {
    float walk[kListed];
    std::uint32_t target[kListed];
  };
  [[nodiscard]] Offer look(std::uint32_t source) const {
    const List& list = lists_[source];
    return look_(list.walk, list.target, listed_[source], tree_.prices());
  }
  void refill(std::uint32_t source, float best);

  const Walks& walks_;
  PriceTree& tree_;
  float margin_;
  decltype(Kernels::look) look_;
  std::unique_ptr<List[]> lists_;
  std::vector<std::uint32_t> listed_;
  std::vector<float> horizon_;
  std::vector<std::uint32_t> target_of_, source_of_;
  std::uint32_t last_target_ = UINT32_MAX;
  PriceTree::Finds finds_;
};

}  // namespace footlight::planner::assignment
