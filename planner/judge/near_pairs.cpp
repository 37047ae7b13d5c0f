// SPDX-License-Identifier: Apache-2.0
#include "planner/judge/near_pairs.hpp"

#include <algorithm>
#include <limits>

#include "planner/cpu_clones.hpp"

namespace footlight::planner::judge {
namespace {

constexpr std::uint32_t kUndivided = 16;
constexpr double kSlack_m = 1e-6;

/// Squares of how near one disc's middle comes to those of `count` others, m^2. Columns: start x, y, end x, y.
FOOTLIGHT_CPU_CLONES
void nearest_squares(const double* middle, const double* const* columns, std::uint32_t count, double* squares_m2) {
  const double* x0 = columns[0];
  const double* y0 = columns[1];
  const double* x1 = columns[2];
  const double* y1 = columns[3];
  for (std::uint32_t k = 0; k < count; ++k) {
    const double px = x0[k] - middle[0];
    const double py = y0[k] - middle[1];
    const double vx = (x1[k] - middle[2]) - px;
    const double vy = (y1[k] - middle[3]) - py;
    const double speed2 = vx * vx + vy * vy + std::numeric_limits<double>::min();
    double when = -(px * vx + py * vy) / speed2;
    when = when < 0 ? 0 : when;
    when = when > 1 ? 1 : when;
    const double qx = px + when * vx;
    const double qy = py + when * vy;
    squares_m2[k] = qx * qx + qy * qy;
  }
}

/// The share of the time from which (to which) a quantity that goes evenly from `a` to `b` is <= 0.
struct Interval {
  double from = 0;
  double to = 1;
  void where_not_positive(double a, double b) {
    if (a <= 0 && b <= 0) return;
    if (a > 0 && b > 0) {
      to = -1;
    } else if (a > 0) {
      from = std::max(from, a / (a - b) - 1e-9);
    } else {
      to = std::min(to, a / (a - b) + 1e-9);
    }
  }
  [[nodiscard]] bool empty() const { return from > to; }
};

/// Whether boxes that move from one place to another, made larger by `reach_m`, overlap at one moment.
bool overlap(const double* low_a, const double* high_a, const double* low_b, const double* high_b, double reach_m) {
  Interval when;
  for (int axis = 0; axis < 2 && !when.empty(); ++axis) {
    const int end = axis + 2;
    when.where_not_positive(low_a[axis] - high_b[axis] - reach_m, low_a[end] - high_b[end] - reach_m);
    when.where_not_positive(low_b[axis] - high_a[axis] - reach_m, low_b[end] - high_a[end] - reach_m);
  }
  return !when.empty();
}

}  // namespace

std::span<const NearPairs::Pair> NearPairs::find(std::span<const MovingDisc> discs) {
  members_.clear();
  for (std::uint32_t i = 0; i < discs.size(); ++i) {
    const MovingDisc& disc = discs[i];
    if (disc.radius_m < 0) continue;
    members_.push_back({{disc.start.x, disc.start.y, disc.end.x, disc.end.y}, disc.radius_m, i});
  }
  pairs_.clear();
  parts_.clear();
  if (members_.empty()) return pairs_;
  divide(0, static_cast<std::uint32_t>(members_.size()));
  for (int side = 0; side < kSides; ++side) {
    column_[side].clear();
    for (const Member& member : members_) column_[side].push_back(member.side[side]);
  }
  column_[kSides].clear();
  for (const Member& member : members_) column_[kSides].push_back(member.radius_m);
  within(0);
  return pairs_;
}

void NearPairs::divide(std::uint32_t begin, std::uint32_t end) {
  const std::size_t here = parts_.size();
  parts_.push_back({});
  Part part{{}, {}, 0, begin, end, 0};
  std::copy_n(members_[begin].side, kSides, part.low);
  std::copy_n(members_[begin].side, kSides, part.high);
  for (std::uint32_t i = begin; i < end; ++i) {
    const Member& member = members_[i];
    for (int side = 0; side < kSides; ++side) {
      part.low[side] = std::min(part.low[side], member.side[side]);
      part.high[side] = std::max(part.high[side], member.side[side]);
    }
    part.radius_m = std::max(part.radius_m, member.radius_m);
  }
  if (end - begin > kUndivided) {
    int spread = 0;
    for (int side = 1; side < kSides; ++side) {
      if (part.high[side] - part.low[side] > part.high[spread] - part.low[spread]) spread = side;
    }
    const std::uint32_t half = begin + (end - begin) / 2;
    std::nth_element(members_.begin() + begin, members_.begin() + half, members_.begin() + end,
                     [spread](const Member& p, const Member& q) { return p.side[spread] < q.side[spread]; });
    divide(begin, half);
    part.second = static_cast<std::uint32_t>(parts_.size());
    divide(half, end);
  }
  parts_[here] = part;
}

void NearPairs::within(std::uint32_t part) {
  const std::uint32_t second = parts_[part].second;
  if (second == 0) return members(parts_[part], parts_[part]);
  within(part + 1);
  within(second);
  between(part + 1, second);
}

void NearPairs::between(std::uint32_t one, std::uint32_t other) {
  const Part& p = parts_[one];
  const Part& q = parts_[other];
  if (!overlap(p.low, p.high, q.low, q.high, p.radius_m + q.radius_m + kSlack_m)) return;
  if (p.second == 0 && q.second == 0) return members(p, q);
  const bool divide_first = q.second == 0 || (p.second != 0 && p.end - p.begin > q.end - q.begin);
  if (divide_first) {
    between(one + 1, other);
    between(p.second, other);
  } else {
    between(one, other + 1);
    between(one, q.second);
  }
}

void NearPairs::members(const Part& one, const Part& other) {
  double squares_m2[kUndivided];
  const double* columns[kSides];
  for (int side = 0; side < kSides; ++side) columns[side] = column_[side].data() + other.begin;
  const double* radii = column_[kSides].data() + other.begin;
  for (std::uint32_t i = one.begin; i < one.end; ++i) {
    const Member& me = members_[i];
    if (!overlap(me.side, me.side, other.low, other.high, me.radius_m + other.radius_m + kSlack_m)) continue;
    nearest_squares(me.side, columns, other.end - other.begin, squares_m2);
    for (std::uint32_t j = &one == &other ? i + 1 : other.begin; j < other.end; ++j) {
      const double reach = me.radius_m + radii[j - other.begin] + kSlack_m;
      if (squares_m2[j - other.begin] > reach * reach) continue;
      pairs_.emplace_back(std::min(me.disc, members_[j].disc), std::max(me.disc, members_[j].disc));
    }
  }
}

}  // namespace footlight::planner::judge
