// SPDX-License-Identifier: Apache-2.0
#include "planner/repair/closest_approach.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace footlight::planner {
namespace {

/// People in square buckets, in the order of the buckets' rows; people beside each other lie in nine of them.
class Buckets {
 public:
  Buckets(const std::vector<Point>& places, double side) : side_(side) {
    low_ = places.front();
    Point high = places.front();
    for (const Point p : places) {
      low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    columns_ = static_cast<int>((high.x - low_.x) / side) + 1;
    rows_ = static_cast<int>((high.y - low_.y) / side) + 1;
    first_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
    for (const Point p : places) ++first_[bucket(p) + 1];
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    people_.resize(places.size());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t i = 0; i < places.size(); ++i) people_[next[bucket(places[i])]++] = i;
  }

  template <class Visit>
  void visit_around(Point p, Visit visit) const {
    const int column = static_cast<int>((p.x - low_.x) / side_);
    const int row = static_cast<int>((p.y - low_.y) / side_);
    for (int r = std::max(0, row - 1); r <= std::min(rows_ - 1, row + 1); ++r) {
      const std::size_t begin = static_cast<std::size_t>(r * columns_ + std::max(0, column - 1));
      const std::size_t end = static_cast<std::size_t>(r * columns_ + std::min(columns_ - 1, column + 1)) + 1;
      for (std::uint32_t at = first_[begin]; at < first_[end]; ++at) visit(people_[at]);
    }
  }

 private:
  [[nodiscard]] std::size_t bucket(Point p) const {
    return static_cast<std::size_t>(static_cast<int>((p.y - low_.y) / side_) * columns_ +
                                    static_cast<int>((p.x - low_.x) / side_));
  }
  double side_;
  Point low_;
  int columns_ = 1;
  int rows_ = 1;
  std::vector<std::uint32_t> first_;
  std::vector<std::uint32_t> people_;
};

}  // namespace

Approach closest_approach(const Walk& a, const Walk& b, double first, double last) {
  const Point start = a.from - b.from;
  const Point change = (a.to - b.to) - start;
  const double square = squared_length(change);
  const double share = square > 0 ? std::clamp(-dot(start, change) / square, first, last) : first;
  return {length(start + share * change), share};
}

std::vector<NearPair> near_pairs(std::span<const Walk> walks, double reach_m, std::span<const char> among) {
  const auto wanted = [&](std::uint32_t i) { return among.empty() || among[i] != 0; };
  std::vector<NearPair> pairs;
  if (walks.size() < 2) return pairs;
  double longest = 0;
  for (const Walk& walk : walks) longest = std::max(longest, distance(walk.from, walk.to));
  const int slices = std::max(1, static_cast<int>(std::ceil(longest / reach_m)));
  // In the middle of a slice two people who come within reach during it are at most so far apart.
  const double side = reach_m + longest / slices + 1e-9;
  std::vector<Point> middle(walks.size());
  for (int slice = 0; slice < slices; ++slice) {
    const double first = static_cast<double>(slice) / slices;
    const double last = static_cast<double>(slice + 1) / slices;
    for (std::size_t i = 0; i < walks.size(); ++i) {
      middle[i] = walks[i].from + (first + last) / 2 * (walks[i].to - walks[i].from);
    }
    const Buckets buckets(middle, side);
    for (std::uint32_t a = 0; a < walks.size(); ++a) {
      if (!wanted(a)) continue;
      buckets.visit_around(middle[a], [&](std::uint32_t b) {
        const bool seen_from_b = b <= a && wanted(b);
        if (seen_from_b || squared_length(middle[a] - middle[b]) > side * side) return;
        const Approach approach = closest_approach(walks[a], walks[b], first, last);
        if (approach.distance_m < reach_m) pairs.push_back({std::min(a, b), std::max(a, b), approach});
      });
    }
  }
  std::sort(pairs.begin(), pairs.end(), [](const NearPair& p, const NearPair& q) {
    return std::tuple(p.a, p.b, p.approach.distance_m, p.approach.share) <
           std::tuple(q.a, q.b, q.approach.distance_m, q.approach.share);
  });
  pairs.erase(std::unique(pairs.begin(), pairs.end(),
                          [](const NearPair& p, const NearPair& q) { return p.a == q.a && p.b == q.b; }),
              pairs.end());
  return pairs;
}

NearPair nearest_pair(std::span<const Walk> walks, double pitch_m) {
  NearPair nearest{0, 0, {std::numeric_limits<double>::infinity(), 0}};
  if (walks.size() < 2) return nearest;
  for (double reach = 1.01 * pitch_m;; reach *= 2) {
    for (const NearPair& pair : near_pairs(walks, reach)) {
      if (pair.approach.distance_m < nearest.approach.distance_m) nearest = pair;
    }
    if (nearest.approach.distance_m < reach) return nearest;
  }
}

}  // namespace footlight::planner
