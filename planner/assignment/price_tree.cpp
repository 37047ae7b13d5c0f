// SPDX-License-Identifier: Apache-2.0
#include "planner/assignment/price_tree.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace footlight::planner::assignment {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::uint32_t kFan = PriceTree::kFan;
using Fan = std::array<float, kFan>;

/// Four floats in one register of any machine; a fan is four of them. Wider registers were measured and did not help.
using Quad [[gnu::vector_size(16)]] = float;

Quad load(const float* from) {
  Quad quad;
  std::memcpy(&quad, from, sizeof quad);
  return quad;
}
void store(Quad quad, float* to) { std::memcpy(to, &quad, sizeof quad); }
Quad all(float value) { return Quad{value, value, value, value}; }
Quad least_of(Quad a, Quad b) { return a < b ? a : b; }
Quad most_of(Quad a, Quad b) { return a > b ? a : b; }
Quad absolute(Quad a) { return most_of(a, -a); }
Quad root(Quad a) {
#if defined(__SSE2__)
  return _mm_sqrt_ps(a);
#else
  return Quad{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])};
#endif
}
/// Bit k: a[k] < limit[k].
std::uint32_t less(Quad a, Quad limit) {
#if defined(__SSE2__)
  return static_cast<std::uint32_t>(_mm_movemask_ps(_mm_cmplt_ps(a, limit)));
#else
  std::uint32_t bits = 0;
  for (std::uint32_t k = 0; k < 4; ++k) bits |= (a[k] < limit[k] ? 1U : 0U) << k;
  return bits;
#endif
}

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

/// One search: a source, and what it still looks for.
template <WalkCost kMetric, bool kLimited>
struct PriceTree::Search {
  const PriceTree& tree;
  float x, y;
  float bound;
  float margin;
  float reach_squared;
  std::vector<Hit>& hits;
  std::size_t found = 0;

  /// Lower bounds of walk + price for sixteen siblings. Bit k is set when the k-th is below the bound.
  std::uint32_t bounds(const Level& level, std::size_t begin, Fan& out) const {
    std::uint32_t open = 0;
    for (std::size_t k = 0; k < kFan; k += 4) {
      const Quad low_x = load(&level.low_x[begin + k]);
      const Quad low_y = load(&level.low_y[begin + k]);
      const Quad high_x = load(&level.high_x[begin + k]);
      const Quad high_y = load(&level.high_y[begin + k]);
      const Quad slope_x = load(&level.slope_x[begin + k]);
      const Quad slope_y = load(&level.slope_y[begin + k]);
      Quad value = load(&level.residual[begin + k]);
      if (kMetric == WalkCost::squared) {
        // min over the box of |z - a|^2 + g.z, axis by axis: the least is at a - g/2, or at the nearest side.
        const Quad zx = least_of(most_of(x - 0.5F * slope_x, low_x), high_x);
        const Quad zy = least_of(most_of(y - 0.5F * slope_y, low_y), high_y);
        value += (zx - x) * (zx - x) + slope_x * zx + (zy - y) * (zy - y) + slope_y * zy;
      } else {
        // |z - a| >= u.(z - a) for every |u| <= 1; u points to the middle of the box.
        const Quad half_x = 0.5F * (high_x - low_x);
        const Quad half_y = 0.5F * (high_y - low_y);
        const Quad dx = low_x + half_x - x;
        const Quad dy = low_y + half_y - y;
        const Quad far = root(dx * dx + dy * dy);
        const Quad inverse = 1.0F / (far + 1e-20F);
        value += far + slope_x * (x + dx) + slope_y * (y + dy) - absolute(dx * inverse + slope_x) * half_x -
                 absolute(dy * inverse + slope_y) * half_y;
      }
      std::uint32_t bits = less(value, all(bound));
      if (kLimited) {
        const Quad dx = most_of(most_of(low_x - x, x - high_x), all(0));
        const Quad dy = most_of(most_of(low_y - y, y - high_y), all(0));
        bits &= less(dx * dx + dy * dy, all(reach_squared));
      }
      store(value, &out[k]);
      open |= bits << k;
    }
    return open;
  }

  void open_leaf(std::size_t begin) {
    Fan value;
    Quad least = all(kInfinity);
    for (std::size_t k = 0; k < kFan; k += 4) {
      const Quad dx = load(&tree.x_[begin + k]) - x;
      const Quad dy = load(&tree.y_[begin + k]) - y;
      const Quad squared = dx * dx + dy * dy;
      Quad sum = (kMetric == WalkCost::squared ? squared : root(squared)) + load(&tree.price_[begin + k]);
      if (kLimited) sum = squared < all(reach_squared) ? sum : all(kInfinity);
      least = least_of(least, sum);
      store(sum, &value[k]);
    }
    bound = std::min(bound, std::min(std::min(least[0], least[1]), std::min(least[2], least[3])) + margin);
    if (hits.size() < found + kFan) hits.resize(2 * found + kFan);
    for (std::size_t quad = 0; quad < kFan; quad += 4) {
      for (std::uint32_t which = less(load(&value[quad]), all(bound)); which != 0; which &= which - 1) {
        const std::size_t k = quad + static_cast<std::size_t>(std::countr_zero(which));
        hits[found++] = {value[k], static_cast<std::uint32_t>(begin + k)};
      }
    }
  }

  void run() {
    struct Open {
      float bound;
      std::uint32_t level;  ///< of the children
      std::uint32_t node;
    };
    std::array<Open, kFan * kMostLevels> stack;  // in any order: the bound is good from the start
    std::size_t open = 0;
    stack[open++] = {-kInfinity, static_cast<std::uint32_t>(tree.levels_.size()), 0};
    while (open > 0) {
      const Open now = stack[--open];
      if (!(now.bound < bound)) continue;
      const std::size_t begin = static_cast<std::size_t>(now.node) * kFan;
      if (now.level == 0) {
        open_leaf(begin);
        continue;
      }
      Fan value;
      const std::uint32_t opened = bounds(tree.levels_[now.level - 1], begin, value);
      for (std::uint32_t which = opened; which != 0; which &= which - 1) {
        const auto k = static_cast<std::uint32_t>(std::countr_zero(which));
        stack[open++] = {value[k], now.level - 1, static_cast<std::uint32_t>(begin) + k};
      }
    }
  }

  static constexpr std::size_t kMostLevels = 8;
};

float PriceTree::value(float x, float y, std::uint32_t target) const {
  const float dx = x_[target] - x;
  const float dy = y_[target] - y;
  const float squared = dx * dx + dy * dy;
  return (metric_ == WalkCost::squared ? squared : std::sqrt(squared)) + price_[target];
}

template <WalkCost kMetric, bool kLimited>
float PriceTree::search(const Query& query, std::vector<Hit>& hits) const {
  const float wide = query.reach * (1 + 1e-5F) + 1e-5F * extent_;
  Search<kMetric, kLimited> search{*this,       query.x, query.y, query.bound, std::max(query.margin, rounding()),
                                   wide * wide, hits};
  search.run();
  std::size_t kept = 0;
  for (std::size_t k = 0; k < search.found; ++k) {
    const Hit hit = hits[k];
    hits[kept] = hit;
    kept += hit.value < search.bound ? 1U : 0U;
  }
  hits.resize(kept);
  return search.bound;
}

float PriceTree::collect(const Query& query, std::vector<Hit>& hits) const {
  const bool limited = query.reach < kInfinity;
  if (metric_ == WalkCost::squared) {
    return limited ? search<WalkCost::squared, true>(query, hits) : search<WalkCost::squared, false>(query, hits);
  }
  return limited ? search<WalkCost::euclidean, true>(query, hits) : search<WalkCost::euclidean, false>(query, hits);
}

}  // namespace footlight::planner::assignment
