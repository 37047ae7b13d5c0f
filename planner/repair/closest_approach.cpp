// SPDX-License-Identifier: Apache-2.0
#include "planner/repair/closest_approach.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace footlight::planner {
namespace {

/// Where somebody is in the middle of a slice of the time.
struct Placed {
  Point at;
  double half_m = 0;  ///< walked from there to either end of the slice
  std::uint32_t person = 0;
};

/// People in square buckets, in the order of the buckets' rows; people beside each other lie in nine of them.
class Buckets {
 public:
  void fill(const std::vector<Placed>& placed, double side) {
    side_ = side;
    low_ = placed.front().at;
    Point high = low_;
    for (const Placed& one : placed) {
      low_ = {std::min(low_.x, one.at.x), std::min(low_.y, one.at.y)};
      high = {std::max(high.x, one.at.x), std::max(high.y, one.at.y)};
    }
    columns_ = column(high) + 1;
    rows_ = row(high) + 1;
    first_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
    for (const Placed& one : placed) ++first_[bucket(one.at)];
    std::uint32_t sum = 0;
    for (std::uint32_t& first : first_) first = sum += first;
    people_.resize(placed.size());
    for (auto one = placed.rbegin(); one != placed.rend(); ++one) people_[--first_[bucket(one->at)]] = *one;
  }

  template <class Visit>
  void visit_around(Point p, Visit visit) const {
    const int left = std::max(0, column(p) - 1);
    const int right = std::min(columns_ - 1, column(p) + 1);
    for (int r = std::max(0, row(p) - 1); r <= std::min(rows_ - 1, row(p) + 1); ++r) {
      const std::size_t begin = first_[static_cast<std::size_t>(r * columns_ + left)];
      const std::size_t end = first_[static_cast<std::size_t>(r * columns_ + right) + 1];
      for (std::size_t at = begin; at < end; ++at) visit(people_[at]);
    }
  }

 private:
  [[nodiscard]] int column(Point p) const { return static_cast<int>((p.x - low_.x) / side_); }
  [[nodiscard]] int row(Point p) const { return static_cast<int>((p.y - low_.y) / side_); }
  [[nodiscard]] std::size_t bucket(Point p) const { return static_cast<std::size_t>(row(p) * columns_ + column(p)); }

  double side_ = 1;
  Point low_;
  int columns_ = 1;
  int rows_ = 1;
  std::vector<std::uint32_t> first_;
  std::vector<Placed> people_;
};

class NearPairs {
 public:
  NearPairs(std::span<const Walk> walks, double reach_m, std::span<const char> among)
      : walks_(walks), reach_m_(reach_m), among_(among), length_m_(walks.size()) {
    for (std::size_t i = 0; i < walks.size(); ++i) {
      length_m_[i] = distance(walks[i].from, walks[i].to);
      longest_m_ = std::max(longest_m_, length_m_[i]);
    }
    slices_ = std::max(1, static_cast<int>(std::ceil(longest_m_ / reach_m)));
    // Rounding must not lose a pair before it is compared exactly.
    square_reach_ = reach_m * reach_m * (1 + 1e-12);
  }

  std::vector<NearPair> run() {
    const auto looked_for = std::count_if(among_.begin(), among_.end(), [](char flag) { return flag != 0; });
    // Filling the buckets of a slice costs about as much as looking from three people at everybody.
    if (!among_.empty() && looked_for <= 3 * std::ptrdiff_t{slices_}) {
      look_from_each();
    } else {
      for (int slice = 0; slice < slices_; ++slice) look_in(slice);
    }
    std::sort(pairs_.begin(), pairs_.end(),
              [](const NearPair& p, const NearPair& q) { return std::tie(p.a, p.b) < std::tie(q.a, q.b); });
    return std::move(pairs_);
  }

 private:
  [[nodiscard]] bool wanted(std::uint32_t i) const { return among_[i] != 0; }

  void look_from_each() {
    const auto people = static_cast<std::uint32_t>(walks_.size());
    for (std::uint32_t a = 0; a < people; ++a) {
      if (!wanted(a)) continue;
      for (std::uint32_t b = 0; b < people; ++b) {
        if (b > a || (b < a && !wanted(b))) compare(a, b, -1);
      }
    }
  }

  /// Two who stand still are nearest in the first slice, as in all others: after it pairs are seen from who walks.
  [[nodiscard]] bool looks(std::uint32_t i, int slice) const {
    return among_.empty() ? slice == 0 || length_m_[i] > 0 : wanted(i);
  }

  void look_in(int slice) {
    const double middle = (slice + 0.5) / slices_;
    placed_.resize(walks_.size());
    for (std::uint32_t i = 0; i < placed_.size(); ++i) {
      const Walk& walk = walks_[i];
      placed_[i] = {walk.from + middle * (walk.to - walk.from), length_m_[i] / (2 * slices_), i};
    }
    // Two people who come within reach during the slice are at most so far apart in the middle of it.
    buckets_.fill(placed_, reach_m_ + longest_m_ / slices_ + 1e-9);
    for (const Placed& a : placed_) {
      if (!looks(a.person, slice)) continue;
      buckets_.visit_around(a.at, [&](const Placed& b) {
        const double apart_m = reach_m_ + a.half_m + b.half_m + 1e-9;
        if (squared_length(a.at - b.at) > apart_m * apart_m) return;
        if (b.person > a.person || (b.person < a.person && !looks(b.person, slice))) compare(a.person, b.person, slice);
      });
    }
  }

  /// @param slice  a pair counts only in the slice in which it is nearest; -1: whenever that is
  void compare(std::uint32_t a, std::uint32_t b, int slice) {
    const Point start = walks_[a].from - walks_[b].from;
    const Point change = (walks_[a].to - walks_[b].to) - start;
    const double square = squared_length(change);
    const double share = square > 0 ? std::clamp(-dot(start, change) / square, 0.0, 1.0) : 0;
    if (squared_length(start + share * change) > square_reach_) return;
    if (slice >= 0 && std::min(slices_ - 1, static_cast<int>(share * slices_)) != slice) return;
    const Approach approach = closest_approach(walks_[a], walks_[b]);
    if (approach.distance_m < reach_m_) pairs_.push_back({std::min(a, b), std::max(a, b), approach});
  }

  std::span<const Walk> walks_;
  double reach_m_;
  std::span<const char> among_;
  std::vector<double> length_m_;
  double longest_m_ = 0;
  int slices_ = 1;
  double square_reach_ = 0;
  std::vector<Placed> placed_;
  Buckets buckets_;
  std::vector<NearPair> pairs_;
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
  if (walks.size() < 2) return {};
  return NearPairs(walks, reach_m, among).run();
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
