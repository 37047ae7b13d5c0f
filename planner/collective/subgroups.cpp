// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/check.hpp"
#include "core/rng.hpp"
#include "planner/collective/affinity.hpp"
#include "planner/motion/neighbours.hpp"

namespace footlight::planner::collective {
namespace {

constexpr std::uint32_t kNeighbours = 48;
constexpr std::uint32_t kLandmarks = 64;
constexpr std::size_t kDrawn = 200'000;  ///< pairs for the median
/// Similarities that differ by less belong to people who keep together in any case, m^2.
constexpr double kAlike_m2 = 1e-9;

/// Far from each other and spread over all points: the first is the nearest to the middle, each next one the farthest
/// from those before (Gonzalez 1985). O(points x landmarks)
std::vector<std::uint32_t> spread(std::span<const Point> points, std::uint32_t wanted) {
  Point middle;
  for (const Point p : points) middle = middle + p;
  middle = 1 / static_cast<double>(points.size()) * middle;
  std::vector<std::uint32_t> out;
  std::vector<double> away(points.size(), std::numeric_limits<double>::infinity());
  std::uint32_t next = 0;
  for (std::uint32_t i = 1; i < points.size(); ++i) {
    if (squared_length(points[i] - middle) < squared_length(points[next] - middle)) next = i;
  }
  while (out.size() < std::min<std::size_t>(wanted, points.size())) {
    out.push_back(next);
    std::uint32_t farthest = 0;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      away[i] = std::min(away[i], squared_length(points[i] - points[out.back()]));
      if (away[i] > away[farthest]) farthest = i;
    }
    next = farthest;
  }
  return out;
}

/// The nearest `wanted` other points, in any order.
class NearestPoints {
 public:
  explicit NearestPoints(std::span<const Point> points) : points_(points) {
    Point low = points.front();
    Point high = low;
    for (const Point p : points) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    widest_m_ = std::max({high.x - low.x, high.y - low.y, 1e-3});
    const double area = std::max(high.x - low.x, 1e-3) * std::max(high.y - low.y, 1e-3);
    spacing_m_ = std::sqrt(area / static_cast<double>(points.size()));
    near_.sort(points, 2 * spacing_m_);
  }

  void find(std::uint32_t of, std::uint32_t wanted, std::vector<std::uint32_t>& out) {
    for (double radius_m = spacing_m_ * std::sqrt(static_cast<double>(wanted));; radius_m *= 1.5) {
      found_.clear();
      near_.visit(points_[of], radius_m, [&](std::uint32_t who, double squared) {
        if (who != of) found_.emplace_back(squared, who);
      });
      if (found_.size() >= wanted || radius_m > 2 * widest_m_) break;
    }
    const auto end = found_.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(wanted, found_.size()));
    std::partial_sort(found_.begin(), end, found_.end());
    for (auto it = found_.begin(); it != end; ++it) out.push_back(it->second);
  }

 private:
  std::span<const Point> points_;
  Neighbours near_;
  double widest_m_ = 1;
  double spacing_m_ = 1;
  std::vector<std::pair<double, std::uint32_t>> found_;
};

float drawn_median(std::span<const Point> from, std::span<const Point> to) {
  Rng rng(from.size());
  std::vector<float> values;
  for (std::size_t n = 0; n < kDrawn; ++n) {
    const std::uint64_t i = rng.below(from.size());
    const std::uint64_t k = rng.below(from.size());
    if (i != k) values.push_back(static_cast<float>(similarity(from[i], from[k], to[i], to[k])));
  }
  if (values.empty()) return 0;
  const auto half = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), half, values.end());
  return *half;
}

/// All of them go the same way.
bool rigid(std::span<const Point> from, std::span<const Point> to) {
  return std::all_of(from.begin(), from.end(), [&, i = std::size_t{0}](Point) mutable {
    const Point change = (to[i] - from[i]) - (to[0] - from[0]);
    ++i;
    return squared_length(change) < kAlike_m2;
  });
}

}  // namespace

SimilarityRows near_similarities(std::span<const Point> from, std::span<const Point> to, std::uint32_t neighbours,
                                 std::uint32_t landmarks) {
  FL_CHECK(from.size() == to.size());
  SimilarityRows rows;
  if (from.empty()) return rows;
  const auto size = static_cast<std::uint32_t>(from.size());
  const std::vector<std::uint32_t> far = spread(from, landmarks);
  const float preference = drawn_median(from, to);
  NearestPoints nearest(from);
  std::vector<std::uint32_t> row;
  for (std::uint32_t i = 0; i < size; ++i) {
    row.assign(far.begin(), far.end());
    row.push_back(i);
    nearest.find(i, std::min(neighbours, size - 1), row);
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    for (const std::uint32_t k : row) {
      rows.add(k, k == i ? preference : static_cast<float>(similarity(from[i], from[k], to[i], to[k])));
    }
    rows.close_row();
  }
  return rows;
}

Clusters find_subgroups(std::span<const Point> from, std::span<const Point> to, const AffinityOptions& options,
                        const std::atomic<bool>* stop) {
  Clusters out;
  if (from.empty()) return out;
  if (rigid(from, to)) {
    // Every partition is as good as any other: they are one.
    out.exemplar_of.assign(from.size(), 0);
    out.converged = true;
    return out;
  }
  return affinity_propagation(
      from.size() <= kMostDense ? all_similarities(from, to) : near_similarities(from, to, kNeighbours, kLandmarks),
      options, stop);
}

}  // namespace footlight::planner::collective
