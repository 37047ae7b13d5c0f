// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "planner/assignment/assignment.hpp"
#include "planner/assignment/kernels.hpp"

namespace footlight::planner::assignment {

/// Finds the targets that are cheap for a source: those with the least walk + price.
///
/// Sixteen targets a leaf, sixteen children a node. Prices of a good dual solution are smooth, so each node keeps a
/// plane fitted to its prices and the least residual above it, and bounds walk + price from below by the least of
/// walk + plane over its box plus that residual. A search then opens four or five leaves at any number of targets.
///
/// Works in single precision: what it returns are candidates, `below` misses none of them.
class PriceTree {
 public:
  /// @param x, y targets in kd_order; near 0, so that single precision serves them well
  PriceTree(std::span<const float> x, std::span<const float> y, WalkCost metric);
  PriceTree(const PriceTree&) = delete;
  PriceTree& operator=(const PriceTree&) = delete;

  /// @param prices one a target; infinity: out of question. O(N)
  void fit(std::span<const float> prices);

  /// Makes a target dearer. The planes stay as they are, since they bound a price from below. O(1)
  void raise(std::uint32_t target, float price) { price_[target] = price; }
  [[nodiscard]] float price(std::uint32_t target) const { return price_[target]; }
  [[nodiscard]] const float* prices() const { return price_.data(); }

  /// Walk + price of one target, as `collect` sees it.
  [[nodiscard]] float value(float x, float y, std::uint32_t target) const;

  struct Query {
    float x, y;  ///< source
    float bound = std::numeric_limits<float>::infinity();
    float margin = std::numeric_limits<float>::infinity();
    float reach = std::numeric_limits<float>::infinity();
    std::uint32_t most = UINT32_MAX;
  };
  /// Room for what one search finds; each thread that searches has its own.
  class Finds {
   public:
    explicit Finds(const PriceTree& tree) : room_(std::make_unique_for_overwrite<Hit[]>(tree.price_.size() + kFan)) {}
    [[nodiscard]] std::span<const Hit> hits() const { return {room_.get(), count_}; }

   private:
    friend PriceTree;
    std::unique_ptr<Hit[]> room_;
    std::size_t count_ = 0;
  };
  /// Targets whose value is below `bound` and not above the least value by more than `margin`, none of them beyond
  /// `reach` (which is taken with a little more than asked for, because of rounding); of more than `most` the cheapest.
  /// O(log N) on good prices and with a good bound
  /// @return the value below which nothing is missing
  float collect(const Query& query, Finds& finds) const;

  /// About the largest |walk| + |price| of this fit.
  [[nodiscard]] float magnitude() const { return magnitude_; }
  /// Values of this fit may be wrong by so much; margins are never less.
  [[nodiscard]] float rounding() const { return kRounding * magnitude_; }

 private:
  /// Structure of arrays; padded to full fans, padding has residual infinity.
  struct Level {
    std::vector<float> low_x, high_x, low_y, high_y;
    std::vector<float> slope_x, slope_y, residual;
    void resize(std::size_t count);
    [[nodiscard]] std::size_t size() const { return residual.size(); }
  };

  static constexpr float kRounding = 1e-6F;  ///< of the largest |walk| + |price|

  static float keep_cheapest(SearchState& state, std::uint32_t most);
  void make_view();
  void fit_leaf(std::uint32_t leaf);
  void fit_node(std::size_t level, std::uint32_t node);

  WalkCost metric_;
  std::uint32_t count_;
  std::vector<float> x_, y_, price_;
  std::vector<Level> levels_;  ///< 0: leaves
  TreeView view_{};            ///< of all that is above
  float extent_ = 0;
  float magnitude_ = 0;
};

}  // namespace footlight::planner::assignment
