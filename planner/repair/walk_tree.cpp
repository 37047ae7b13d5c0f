// SPDX-License-Identifier: Apache-2.0
#include "planner/repair/walk_tree.hpp"

#include <algorithm>
#include <limits>

#include "core/check.hpp"
#include "planner/cpu_clones.hpp"

namespace footlight::planner {
namespace {

/// People in a leaf: a leaf is compared with a leaf at once.
constexpr std::uint32_t kLeaf = 16;
/// Rounding must not lose a pair before it is compared exactly.
constexpr double kRounding_m = 1e-9;

/// Shares of the time, [first, last], in which a line from `from` to `to` is at most `limit`; narrows the interval.
void keep_below(double from, double to, double limit, double& first, double& last) {
  if (from <= limit && to <= limit) return;
  const double share = (limit - from) / (to - from);
  if (from > limit) {
    first = std::max(first, to < from ? share : 2.0);
  } else {
    last = std::min(last, share);
  }
}

/// Ends of people as columns: start x, y, end x, y.
struct Columns {
  const double* at[4];
};

/// Squares of the least distances of one person from `many` others, m^2.
FOOTLIGHT_CPU_CLONES
void least_squares(const double* me, Columns others, std::uint32_t many, double* squared_m2) {
  for (std::uint32_t j = 0; j < many; ++j) {
    const double x = me[0] - others.at[0][j];
    const double y = me[1] - others.at[1][j];
    const double dx = me[2] - others.at[2][j] - x;
    const double dy = me[3] - others.at[3][j] - y;
    const double along = x * dx + y * dy;
    // The smallest number stands in for no change at all.
    const double share =
        std::min(std::max(-along / (dx * dx + dy * dy + std::numeric_limits<double>::min()), 0.0), 1.0);
    const double px = x + share * dx;
    const double py = y + share * dy;
    squared_m2[j] = px * px + py * py;
  }
}

bool in_order(const NearPair& p, const NearPair& q) { return p.a != q.a ? p.a < q.a : p.b < q.b; }

/// Whether the difference of a point in one box and one in the other, moving from starts to ends, may be within reach
/// of zero on both axes at one moment.
template <class Low, class High>
bool may_meet(const Low& a_low, const High& a_high, const Low& b_low, const High& b_high, double reach_m) {
  double first = 0;
  double last = 1;
  for (std::size_t d = 0; d < 2; ++d) {
    const double low0 = a_low[d] - b_high[d];
    const double low1 = a_low[d + 2] - b_high[d + 2];
    const double high0 = a_high[d] - b_low[d];
    const double high1 = a_high[d + 2] - b_low[d + 2];
    if ((low0 > reach_m && low1 > reach_m) || (high0 < -reach_m && high1 < -reach_m)) return false;
    keep_below(low0, low1, reach_m, first, last);
    keep_below(-high0, -high1, reach_m, first, last);
  }
  return first <= last + 1e-9;
}

}  // namespace

void WalkTree::build(std::span<const Walk> walks) {
  entries_.resize(walks.size());
  for (std::uint32_t i = 0; i < walks.size(); ++i) {
    entries_[i] = {{walks[i].from.x, walks[i].from.y, walks[i].to.x, walks[i].to.y}, i};
  }
  nodes_.clear();
  if (!walks.empty()) split(0, static_cast<std::uint32_t>(walks.size()));
  fit_boxes();
}

void WalkTree::move(std::span<const Walk> walks) {
  FL_CHECK(walks.size() == entries_.size());
  for (Entry& entry : entries_) {
    const Walk& walk = walks[entry.person];
    entry.at = {walk.from.x, walk.from.y, walk.to.x, walk.to.y};
  }
  fit_boxes();
}

std::uint32_t WalkTree::split(std::uint32_t first, std::uint32_t last) {
  const auto here = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({{}, {}, first, last, 0, true});
  if (last - first <= kLeaf) return here;
  Ends low = entries_[first].at;
  Ends high = low;
  for (std::uint32_t i = first + 1; i < last; ++i) {
    for (std::size_t d = 0; d < 4; ++d) {
      low[d] = std::min(low[d], entries_[i].at[d]);
      high[d] = std::max(high[d], entries_[i].at[d]);
    }
  }
  std::size_t widest = 0;
  for (std::size_t d = 1; d < 4; ++d) {
    if (high[d] - low[d] > high[widest] - low[widest]) widest = d;
  }
  // Whole leaves on the left, so that the leaves are full.
  const std::uint32_t middle = first + ((last - first) / 2 + kLeaf - 1) / kLeaf * kLeaf;
  std::nth_element(entries_.begin() + first, entries_.begin() + middle, entries_.begin() + last,
                   [widest](const Entry& p, const Entry& q) { return p.at[widest] < q.at[widest]; });
  split(first, middle);
  nodes_[here].right = split(middle, last);
  return here;
}

void WalkTree::fit_boxes() {
  for (std::size_t d = 0; d < 4; ++d) {
    column_[d].resize(entries_.size());
    for (std::size_t i = 0; i < entries_.size(); ++i) column_[d][i] = entries_[i].at[d];
  }
  for (std::size_t n = nodes_.size(); n-- > 0;) {
    Node& node = nodes_[n];
    for (std::size_t d = 0; d < 4; ++d) {
      if (node.right != 0) {
        node.low[d] = std::min(nodes_[n + 1].low[d], nodes_[node.right].low[d]);
        node.high[d] = std::max(nodes_[n + 1].high[d], nodes_[node.right].high[d]);
        continue;
      }
      const auto [low, high] = std::minmax_element(column_[d].begin() + node.first, column_[d].begin() + node.last);
      node.low[d] = *low;
      node.high[d] = *high;
    }
  }
}

void WalkTree::flag(std::span<const char> among) {
  FL_CHECK(among.empty() || among.size() == entries_.size());
  wanted_.assign(entries_.size(), 1);
  if (!among.empty()) {
    for (std::size_t i = 0; i < entries_.size(); ++i) wanted_[i] = among[entries_[i].person];
  }
  for (std::size_t n = nodes_.size(); n-- > 0;) {
    Node& node = nodes_[n];
    node.wanted = node.right != 0 ? nodes_[n + 1].wanted || nodes_[node.right].wanted
                                  : std::any_of(wanted_.begin() + node.first, wanted_.begin() + node.last,
                                                [](char flag) { return flag != 0; });
  }
}

template <class Visit>
void WalkTree::join(std::uint32_t a, std::uint32_t b, const double& reach_m, Visit& visit) const {
  const Node& p = nodes_[a];
  const Node& q = nodes_[b];
  if (!p.wanted && !q.wanted) return;
  if (a == b) {
    if (p.right == 0) return compare(p, p, reach_m, visit);
    join(a + 1, a + 1, reach_m, visit);
    join(p.right, p.right, reach_m, visit);
    return join(a + 1, p.right, reach_m, visit);
  }
  if (!may_meet(p.low, p.high, q.low, q.high, reach_m + kRounding_m)) return;
  if (p.right == 0 && q.right == 0) return compare(p, q, reach_m, visit);
  if (q.right == 0 || (p.right != 0 && p.last - p.first >= q.last - q.first)) {
    join(a + 1, b, reach_m, visit);
    return join(p.right, b, reach_m, visit);
  }
  join(a, b + 1, reach_m, visit);
  join(a, q.right, reach_m, visit);
}

template <class Visit>
void WalkTree::compare(const Node& a, const Node& b, const double& reach_m, Visit& visit) const {
  std::array<double, kLeaf> squared_m2;
  const std::uint32_t many = b.last - b.first;
  const Columns others{{&column_[0][b.first], &column_[1][b.first], &column_[2][b.first], &column_[3][b.first]}};
  for (std::uint32_t i = a.first; i < a.last; ++i) {
    const Ends& me = entries_[i].at;
    if (!b.wanted && wanted_[i] == 0) continue;
    if (!may_meet(me, me, b.low, b.high, reach_m + kRounding_m)) continue;
    least_squares(me.data(), others, many, squared_m2.data());
    const double limit_m2 = (reach_m + kRounding_m) * (reach_m + kRounding_m);
    const std::uint32_t begin = &a == &b ? i - a.first + 1 : 0;
    for (std::uint32_t j = begin; j < many; ++j) {
      if (squared_m2[j] > limit_m2) continue;
      if (wanted_[i] == 0 && wanted_[b.first + j] == 0) continue;
      visit(entries_[i], entries_[b.first + j]);
    }
  }
}

void WalkTree::find(double reach_m, std::span<const char> among, Pairs which, std::vector<NearPair>& found) {
  found.clear();
  if (entries_.empty()) return;
  flag(among);
  const auto visit = [&](const Entry& p, const Entry& q) {
    const Walk a = p.walk();
    const Walk b = q.walk();
    if (which == Pairs::opposed && dot(a.from - b.from, a.to - b.to) >= 0) return;
    const Approach approach = closest_approach(a, b);
    if (approach.distance_m >= reach_m) return;
    found.push_back({std::min(p.person, q.person), std::max(p.person, q.person), approach});
  };
  join(0, 0, reach_m, visit);
  sort(found);
}

void WalkTree::sort(std::vector<NearPair>& found) {
  // By a in one counting pass; what is left to sort is short.
  first_of_.assign(entries_.size() + 1, 0);
  for (const NearPair& pair : found) ++first_of_[pair.a + 1];
  for (std::size_t i = 1; i < first_of_.size(); ++i) first_of_[i] += first_of_[i - 1];
  sorted_.resize(found.size());
  for (const NearPair& pair : found) sorted_[first_of_[pair.a]++] = pair;
  for (std::size_t begin = 0, end = 0; begin < sorted_.size(); begin = end) {
    end = first_of_[sorted_[begin].a];
    std::sort(sorted_.begin() + static_cast<std::ptrdiff_t>(begin), sorted_.begin() + static_cast<std::ptrdiff_t>(end),
              in_order);
  }
  found.swap(sorted_);
}

NearPair WalkTree::nearest() {
  FL_CHECK(entries_.size() >= 2);
  flag({});
  NearPair best{0, 0, {std::numeric_limits<double>::infinity(), 0}};
  const auto visit = [&](const Entry& p, const Entry& q) {
    const NearPair pair{std::min(p.person, q.person), std::max(p.person, q.person),
                        closest_approach(p.walk(), q.walk())};
    const double nearer_m = pair.approach.distance_m - best.approach.distance_m;
    if (nearer_m < 0 || (nearer_m == 0 && in_order(pair, best))) best = pair;
  };
  for (std::size_t i = 1; i < entries_.size(); ++i) visit(entries_[i - 1], entries_[i]);
  join(0, 0, best.approach.distance_m, visit);
  return best;
}

}  // namespace footlight::planner
