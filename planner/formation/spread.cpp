// SPDX-License-Identifier: Apache-2.0
#include "planner/formation/spread.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <unordered_map>
#include <utility>

namespace footlight::planner {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr double kRounding_m = 1e-9;

/// Points in square bins of a fixed side, added and taken away one by one.
class Bins {
 public:
  explicit Bins(double side_m) : side_m_(side_m) {}

  void add(Point at, std::uint32_t number) { bins_[key(bin(at.x), bin(at.y))].push_back({at, number}); }
  void take_away(Point at, std::uint32_t number) {
    auto& here = bins_[key(bin(at.x), bin(at.y))];
    std::erase_if(here, [&](const Entry& entry) { return entry.number == number; });
  }
  /// Calls visit(number, squared distance) for every point but `number` within one side.
  template <class Visit>
  void near(Point at, std::uint32_t number, Visit visit) const {
    const std::int64_t column = bin(at.x);
    const std::int64_t row = bin(at.y);
    for (std::int64_t y = row - 1; y <= row + 1; ++y) {
      for (std::int64_t x = column - 1; x <= column + 1; ++x) {
        const auto found = bins_.find(key(x, y));
        if (found == bins_.end()) continue;
        for (const Entry& entry : found->second) {
          const double squared = squared_length(entry.at - at);
          if (entry.number != number && squared <= side_m_ * side_m_) visit(entry.number, squared);
        }
      }
    }
  }
  /// Squared distance of the nearest of them; infinity when there is none.
  [[nodiscard]] double nearest(Point at, std::uint32_t number) const {
    double least = kFar;
    near(at, number, [&](std::uint32_t, double squared) { least = std::min(least, squared); });
    return least;
  }

 private:
  struct Entry {
    Point at;
    std::uint32_t number = 0;
  };
  [[nodiscard]] std::int64_t bin(double metres) const {
    return static_cast<std::int64_t>(std::floor(metres / side_m_));
  }
  static std::uint64_t key(std::int64_t x, std::int64_t y) {
    return static_cast<std::uint64_t>(x) << 32U ^ static_cast<std::uint64_t>(y & 0xFFFFFFFF);
  }

  double side_m_;
  std::unordered_map<std::uint64_t, std::vector<Entry>> bins_;
};

double extent(std::span<const Point> points) {
  Point low = points.front();
  Point high = low;
  for (const Point p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  return std::max(high.x - low.x, high.y - low.y);
}

/// Numbers of points of which none is nearer to one before than `apart_m`, first come, first served.
std::vector<std::uint32_t> kept_at(std::span<const Point> points, double apart_m) {
  std::vector<std::uint32_t> kept;
  Bins bins(apart_m);
  const double least = (apart_m - kRounding_m) * (apart_m - kRounding_m);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (bins.nearest(points[i], i) < least) continue;
    bins.add(points[i], i);
    kept.push_back(i);
  }
  return kept;
}

/// Leaves out one of the two that are nearest to each other, the later one, until so many are left.
void leave_out_nearest(std::span<const Point> points, std::vector<std::uint32_t>& kept, std::size_t wanted,
                       double apart_m) {
  Bins bins(2 * apart_m);
  for (const std::uint32_t i : kept) bins.add(points[i], i);
  std::vector<double> nearest(points.size(), kFar);
  using Crowded = std::pair<double, std::uint32_t>;  // the nearest first, of equals the later point
  const auto before = [](const Crowded& a, const Crowded& b) {
    return a.first < b.first || (a.first == b.first && a.second > b.second);
  };
  std::set<Crowded, decltype(before)> order(before);
  for (const std::uint32_t i : kept) order.emplace(nearest[i] = bins.nearest(points[i], i), i);
  while (order.size() > wanted) {
    const std::uint32_t gone = order.begin()->second;
    order.erase(order.begin());
    bins.take_away(points[gone], gone);
    bins.near(points[gone], gone, [&](std::uint32_t i, double) {
      order.erase({nearest[i], i});
      order.emplace(nearest[i] = bins.nearest(points[i], i), i);
    });
  }
  kept.clear();
  for (const auto& [distance_m, i] : order) kept.push_back(i);
  std::sort(kept.begin(), kept.end());
}

}  // namespace

double least_distance(std::span<const Point> points) {
  if (points.size() < 2) return kFar;
  const double wide = extent(points);
  if (wide <= 0) return 0;
  // A side at which a bin holds few points, then twice as wide until there is a neighbour at all.
  for (double side = wide / std::sqrt(static_cast<double>(points.size()));; side *= 2) {
    Bins bins(side);
    double least = kFar;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      least = std::min(least, bins.nearest(points[i], i));
      bins.add(points[i], i);
    }
    if (least < kFar) return std::sqrt(least);
  }
}

std::vector<Point> thin(std::span<const Point> points, std::size_t wanted, double least_m) {
  std::vector<Point> out;
  if (points.empty() || wanted == 0) return out;
  double low = std::max(least_m, 1e-6);
  std::vector<std::uint32_t> kept = kept_at(points, low);
  if (kept.size() > wanted) {
    double high = extent(points) + 1;
    for (int halving = 0; halving < 40 && kept.size() > wanted; ++halving) {
      const double middle = (low + high) / 2;
      auto fewer = kept_at(points, middle);
      if (fewer.size() >= wanted) {
        low = middle;
        kept = std::move(fewer);
      } else {
        high = middle;
      }
    }
    leave_out_nearest(points, kept, wanted, low);
  }
  for (const std::uint32_t i : kept) out.push_back(points[i]);
  return out;
}

}  // namespace footlight::planner
