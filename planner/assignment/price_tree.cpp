// SPDX-License-Identifier: Apache-2.0
#include "planner/assignment/price_tree.hpp"

#include <algorithm>
#include <cmath>

#include "core/check.hpp"

namespace footlight::planner::assignment {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

std::size_t padded(std::size_t count) { return (count + kFan - 1) / kFan * kFan; }

}  // namespace

void PriceTree::Level::resize(std::size_t count) {
  for (auto* column : {&low_x, &low_y, &high_x, &high_y, &slope_x, &slope_y}) column->assign(padded(count), 0);
  residual.assign(padded(count), kInfinity);
}

PriceTree::PriceTree(std::span<const float> x, std::span<const float> y, WalkCost metric)
    : metric_(metric), count_(static_cast<std::uint32_t>(x.size())), x_(x.begin(), x.end()), y_(y.begin(), y.end()) {
  x_.resize(padded(count_), 0);
  y_.resize(padded(count_), 0);
  price_.assign(padded(count_), kInfinity);
  for (std::size_t nodes = padded(count_) / kFan;; nodes = padded(nodes) / kFan) {
    levels_.emplace_back().resize(nodes);
    if (nodes <= kFan) break;
  }
  for (std::uint32_t i = 0; i < count_; ++i) extent_ = std::max({extent_, std::abs(x[i]), std::abs(y[i])});
  for (std::size_t k = 0; k < levels_.size(); ++k) {
    Level& level = levels_[k];
    std::size_t below = count_;
    for (std::size_t up = 0; up < k; ++up) below = (below + kFan - 1) / kFan;
    const Level* lower = k == 0 ? nullptr : &levels_[k - 1];
    for (std::size_t i = 0; i < below; ++i) {
      const std::size_t node = i / kFan;
      const float lx = lower ? lower->low_x[i] : x_[i];
      const float hx = lower ? lower->high_x[i] : x_[i];
      const float ly = lower ? lower->low_y[i] : y_[i];
      const float hy = lower ? lower->high_y[i] : y_[i];
      const bool first = i % kFan == 0;
      level.low_x[node] = first ? lx : std::min(level.low_x[node], lx);
      level.high_x[node] = first ? hx : std::max(level.high_x[node], hx);
      level.low_y[node] = first ? ly : std::min(level.low_y[node], ly);
      level.high_y[node] = first ? hy : std::max(level.high_y[node], hy);
    }
  }
  make_view();
}

void PriceTree::make_view() {
  FL_CHECK(levels_.size() <= TreeView::kMostLevels);
  view_.x = x_.data();
  view_.y = y_.data();
  view_.price = price_.data();
  view_.levels = static_cast<std::uint32_t>(levels_.size());
  for (std::size_t k = 0; k < levels_.size(); ++k) {
    const Level& level = levels_[k];
    view_.level[k] = {level.low_x.data(),   level.high_x.data(),  level.low_y.data(),   level.high_y.data(),
                      level.slope_x.data(), level.slope_y.data(), level.residual.data()};
  }
}

void PriceTree::fit(std::span<const float> prices) {
  std::ranges::copy(prices, price_.begin());
  magnitude_ = 0;
  for (const float price : prices) {
    if (price < kInfinity) magnitude_ = std::max(magnitude_, std::abs(price));
  }
  magnitude_ += metric_ == WalkCost::squared ? 8 * extent_ * extent_ : 3 * extent_;
  std::uint32_t nodes = (count_ + kFan - 1) / kFan;
  for (std::uint32_t leaf = 0; leaf < nodes; ++leaf) fit_leaf(leaf);
  for (std::size_t level = 1; level < levels_.size(); ++level) {
    nodes = (nodes + kFan - 1) / kFan;
    for (std::uint32_t node = 0; node < nodes; ++node) fit_node(level, node);
  }
}

/// Least squares of the finite prices; the slope is 0 along an axis on which the leaf has no extent.
void PriceTree::fit_leaf(std::uint32_t leaf) {
  const float* x = &x_[static_cast<std::size_t>(leaf) * kFan];
  const float* y = &y_[static_cast<std::size_t>(leaf) * kFan];
  const float* p = &price_[static_cast<std::size_t>(leaf) * kFan];
  float count = 0;
  float mean_x = 0;
  float mean_y = 0;
  float mean_p = 0;
  for (std::uint32_t k = 0; k < kFan; ++k) {
    const bool counts = p[k] < kInfinity;
    count += counts ? 1.0F : 0.0F;
    mean_x += counts ? x[k] : 0.0F;
    mean_y += counts ? y[k] : 0.0F;
    mean_p += counts ? p[k] : 0.0F;
  }
  Level& level = levels_[0];
  if (count == 0) {
    level.slope_x[leaf] = level.slope_y[leaf] = 0;
    level.residual[leaf] = kInfinity;
    return;
  }
  mean_x /= count;
  mean_y /= count;
  mean_p /= count;
  float xx = 0;
  float yy = 0;
  float xy = 0;
  float xp = 0;
  float yp = 0;
  for (std::uint32_t k = 0; k < kFan; ++k) {
    const bool counts = p[k] < kInfinity;
    const float dx = counts ? x[k] - mean_x : 0.0F;
    const float dy = counts ? y[k] - mean_y : 0.0F;
    const float dp = counts ? p[k] - mean_p : 0.0F;
    xx += dx * dx;
    yy += dy * dy;
    xy += dx * dy;
    xp += dx * dp;
    yp += dy * dp;
  }
  // A little ridge keeps collinear leaves (determinant 0) from a wild slope across their line.
  const float ridge = 1e-3F * (xx + yy);
  const float determinant = (xx + ridge) * (yy + ridge) - xy * xy;
  const float slope_x = determinant > 0 ? (xp * (yy + ridge) - yp * xy) / determinant : 0.0F;
  const float slope_y = determinant > 0 ? (yp * (xx + ridge) - xp * xy) / determinant : 0.0F;
  float residual = kInfinity;
  for (std::uint32_t k = 0; k < kFan; ++k) {
    const float r = p[k] - (slope_x * x[k] + slope_y * y[k]);
    residual = r < residual ? r : residual;
  }
  level.slope_x[leaf] = slope_x;
  level.slope_y[leaf] = slope_y;
  level.residual[leaf] = residual - kRounding * (magnitude_ + extent_ * (std::abs(slope_x) + std::abs(slope_y)));
}

/// The mean of the children's planes; each child's residual is lowered by what the two planes differ over its box.
void PriceTree::fit_node(std::size_t level, std::uint32_t node) {
  const Level& lower = levels_[level - 1];
  const std::size_t begin = static_cast<std::size_t>(node) * kFan;
  float count = 0;
  float slope_x = 0;
  float slope_y = 0;
  for (std::size_t k = begin; k < begin + kFan; ++k) {
    const bool counts = lower.residual[k] < kInfinity;
    count += counts ? 1.0F : 0.0F;
    slope_x += counts ? lower.slope_x[k] : 0.0F;
    slope_y += counts ? lower.slope_y[k] : 0.0F;
  }
  slope_x = count > 0 ? slope_x / count : 0;
  slope_y = count > 0 ? slope_y / count : 0;
  float residual = kInfinity;
  for (std::size_t k = begin; k < begin + kFan; ++k) {
    const float dx = lower.slope_x[k] - slope_x;
    const float dy = lower.slope_y[k] - slope_y;
    const float r = lower.residual[k] + std::min(dx * lower.low_x[k], dx * lower.high_x[k]) +
                    std::min(dy * lower.low_y[k], dy * lower.high_y[k]);
    residual = r < residual ? r : residual;
  }
  Level& upper = levels_[level];
  upper.slope_x[node] = slope_x;
  upper.slope_y[node] = slope_y;
  upper.residual[node] = residual - kRounding * extent_ * (std::abs(slope_x) + std::abs(slope_y));
}

float PriceTree::value(float x, float y, std::uint32_t target) const {
  const float dx = x_[target] - x;
  const float dy = y_[target] - y;
  const float squared = dx * dx + dy * dy;
  return (metric_ == WalkCost::squared ? squared : std::sqrt(squared)) + price_[target];
}

/// @return the least value of those that are not kept
float PriceTree::keep_cheapest(SearchState& state, std::uint32_t most) {
  std::nth_element(state.hits, state.hits + most, state.hits + state.found, [](const Hit& a, const Hit& b) {
    return a.value < b.value || (a.value == b.value && a.target < b.target);
  });
  state.found = most;
  return state.hits[most].value;
}

float PriceTree::collect(const Query& query, Finds& finds) const {
  const float wide = query.reach * (1 + 1e-5F) + 1e-5F * extent_;
  const bool limited = query.reach < kInfinity;
  const auto kernel = kernels().search[metric_ == WalkCost::euclidean ? 1 : 0][limited ? 1 : 0];
  SearchState state;
  state.x = query.x;
  state.y = query.y;
  state.bound = query.bound;
  state.margin = std::max(query.margin, rounding());
  state.reach_squared = wide * wide;
  // Sorting out what is too much every now and then keeps the bound low, and costs little.
  state.pause_at = query.most < UINT32_MAX / 2 ? 2 * query.most + kFan : UINT32_MAX;
  state.hits = finds.room_.get();
  state.stack[state.open++] = {-kInfinity, view_.levels, 0};
  while (true) {
    kernel(view_, state);
    if (state.open == 0) break;
    state.bound = std::min(state.bound, keep_cheapest(state, query.most));
  }
  if (state.found > query.most) state.bound = std::min(state.bound, keep_cheapest(state, query.most));
  // Not only what is below the bound: where more than `most` are equally good, those that were kept lie on it.
  std::size_t kept = 0;
  for (std::uint32_t k = 0; k < state.found; ++k) {
    const Hit hit = state.hits[k];
    state.hits[kept] = hit;
    kept += hit.value <= state.bound ? 1U : 0U;
  }
  finds.count_ = kept;
  return state.bound;
}

}  // namespace footlight::planner::assignment
