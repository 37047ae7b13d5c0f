// SPDX-License-Identifier: Apache-2.0
#include "planner/assignment/assignment.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>

#include "core/check.hpp"
#include "planner/assignment/auction.hpp"
#include "planner/assignment/kd_order.hpp"
#include "planner/assignment/match_walks.hpp"
#include "planner/assignment/phases.hpp"
#include "planner/assignment/price_tree.hpp"

namespace footlight::planner {
namespace {

using assignment::ArcRows;
using assignment::hold_auction;
using assignment::kd_order;
using assignment::match_walks;
using assignment::Matching;
using assignment::Phases;
using assignment::PriceTree;
using assignment::Value;
using assignment::Walks;

double walk_cost(Point a, Point b, WalkCost cost) {
  return cost == WalkCost::squared ? squared_length(a - b) : distance(a, b);
}

std::optional<Assignment> assign_all(std::span<const Point> sources, std::span<const Point> targets, WalkCost cost,
                                     double longest_m, const std::atomic<bool>* stop) {
  Assignment result;
  if (sources.empty()) return result;
  const Walks walks(sources, targets, cost, longest_m);
  const auto matching = match_walks(walks, stop);
  if (!matching) return std::nullopt;
  const std::uint32_t size = walks.size();
  result.looked_at = matching->looked_at;
  result.target_of.resize(size);
  result.source_value.resize(size);
  result.target_value.resize(size);
  // |a - b|^2 = |d|^2 + 2 shift.(a - b) - |shift|^2 with d = a - b - shift, whose square was the cost.
  const Point shift = cost == WalkCost::squared ? walks.shift() : Point{};
  Value primal = 0;
  Value dual = 0;
  for (std::uint32_t i = 0; i < size; ++i) {
    const std::uint32_t source = walks.sources().original[i];
    const std::uint32_t target = walks.targets().original[i];
    result.target_of[source] = walks.targets().original[matching->target_of[i]];
    result.source_value[source] = static_cast<double>(matching->value[i]) * walks.unit() +
                                  2 * dot(shift, sources[source]) - squared_length(shift);
    result.target_value[target] =
        -static_cast<double>(matching->price[i]) * walks.unit() - 2 * dot(shift, targets[target]);
    primal += walks.cost(i, matching->target_of[i]);
    dual += matching->value[i] - matching->price[i];
  }
  for (std::uint32_t i = 0; i < size; ++i) result.cost += walk_cost(sources[i], targets[result.target_of[i]], cost);
  result.gap = static_cast<double>(primal - dual) * walks.unit();
  return result;
}

/// Indices into both sides of the points that both have, and of the others.
struct Common {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> both;
  std::vector<std::uint32_t> sources, targets;
};

std::vector<std::uint32_t> in_order(std::span<const Point> points) {
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(order, {}, [&](std::uint32_t i) { return std::pair(points[i].x, points[i].y); });
  return order;
}

Common find_common(std::span<const Point> sources, std::span<const Point> targets) {
  const auto source_order = in_order(sources);
  const auto target_order = in_order(targets);
  const auto key = [](Point p) { return std::pair(p.x, p.y); };
  Common common;
  std::size_t t = 0;
  for (const std::uint32_t i : source_order) {
    for (; t < target_order.size() && key(targets[target_order[t]]) < key(sources[i]); ++t) {
      common.targets.push_back(target_order[t]);
    }
    if (t < target_order.size() && targets[target_order[t]] == sources[i]) {
      common.both.emplace_back(i, target_order[t++]);
    } else {
      common.sources.push_back(i);
    }
  }
  common.targets.insert(common.targets.end(), target_order.begin() + static_cast<std::ptrdiff_t>(t),
                        target_order.end());
  return common;
}

/// phi(z) = min over targets j of |z - j| - value_j, the potential of which a dual solution of a metric cost is made.
class Potential {
 public:
  Potential(std::span<const Point> targets, std::span<const double> values)
      : order_(kd_order(targets)),
        targets_(targets),
        values_(values),
        tree_(make_tree()),
        finds_(std::make_unique<PriceTree::Finds>(*tree_)) {}

  double operator()(Point z) {
    const Point at = z - zero_;
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    // No margin: what rounding leaves undecided is decided below.
    tree_->collect({static_cast<float>(at.x), static_cast<float>(at.y), kInfinity, 0, kInfinity}, *finds_);
    double least = std::numeric_limits<double>::infinity();
    for (const auto& hit : finds_->hits()) {
      const std::uint32_t target = order_[hit.target];
      least = std::min(least, distance(z, targets_[target]) - values_[target]);
    }
    return least;
  }

 private:
  std::unique_ptr<PriceTree> make_tree() {
    zero_ = targets_.empty() ? Point{} : targets_[order_[order_.size() / 2]];
    std::vector<float> x;
    std::vector<float> y;
    std::vector<float> price;
    for (const std::uint32_t target : order_) {
      x.push_back(static_cast<float>(targets_[target].x - zero_.x));
      y.push_back(static_cast<float>(targets_[target].y - zero_.y));
      price.push_back(static_cast<float>(-values_[target]));
    }
    auto tree = std::make_unique<PriceTree>(x, y, WalkCost::euclidean);
    tree->fit(price);
    return tree;
  }

  std::vector<std::uint32_t> order_;
  std::span<const Point> targets_;
  std::span<const double> values_;
  Point zero_;
  std::unique_ptr<PriceTree> tree_;
  std::unique_ptr<PriceTree::Finds> finds_;
};

/// By the triangle inequality an exchange that lets everybody stay who stands on a target never costs distance.
std::optional<Assignment> assign_where_common_points_stay(std::span<const Point> sources,
                                                          std::span<const Point> targets,
                                                          const std::atomic<bool>* stop) {
  const Common common = find_common(sources, targets);
  std::vector<Point> from;
  std::vector<Point> to;
  from.reserve(common.sources.size());
  to.reserve(common.targets.size());
  for (const std::uint32_t i : common.sources) from.push_back(sources[i]);
  for (const std::uint32_t j : common.targets) to.push_back(targets[j]);
  const auto rest = assign_all(from, to, WalkCost::euclidean, std::numeric_limits<double>::infinity(), stop);
  if (!rest) return std::nullopt;
  Assignment result;
  result.looked_at = rest->looked_at;
  result.cost = rest->cost;
  result.gap = rest->gap;
  result.target_of.resize(sources.size());
  result.source_value.assign(sources.size(), 0);
  result.target_value.assign(sources.size(), 0);
  for (std::size_t k = 0; k < from.size(); ++k) {
    result.target_of[common.sources[k]] = common.targets[rest->target_of[k]];
    result.source_value[common.sources[k]] = rest->source_value[k];
    result.target_value[common.targets[k]] = rest->target_value[k];
  }
  for (const auto& [i, j] : common.both) result.target_of[i] = j;
  if (from.empty()) return result;
  Potential potential(to, rest->target_value);
  for (const auto& [i, j] : common.both) {
    result.source_value[i] = potential(sources[i]);
    result.target_value[j] = -result.source_value[i];
  }
  return result;
}

/// The median of what the arcs of one source differ by.
Value typical_spread(const ArcRows& rows) {
  std::vector<Value> spreads;
  for (std::uint32_t i = 0; i < rows.size(); ++i) {
    if (rows.first[i + 1] - rows.first[i] < 2) continue;
    const auto [least, most] =
        std::ranges::minmax(std::span(rows.cost).subspan(rows.first[i], rows.first[i + 1] - rows.first[i]));
    spreads.push_back(most - least);
  }
  if (spreads.empty()) return 0;
  const auto middle = spreads.begin() + static_cast<std::ptrdiff_t>(spreads.size() / 2);
  std::ranges::nth_element(spreads, middle);
  return *middle;
}

/// Ever smaller steps, from what the dearest arc costs to a small part of what matters to most.
void hold_auctions(const ArcRows& rows, Value dearest, Matching& matching) {
  constexpr Value kShrink = 5;
  constexpr Value kFinest = 10'000;
  constexpr std::uint64_t kMostBids = 40;  // a source
  const Value last = typical_spread(rows) / kFinest;
  for (Value step = dearest / 8; step > std::max<Value>(last, 1); step /= kShrink) {
    hold_auction(rows, step, kMostBids * rows.size(), matching);
  }
}

double longest_walk(std::span<const Point> sources, std::span<const Point> targets,
                    std::span<const std::uint32_t> target_of) {
  double longest = 0;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    longest = std::max(longest, distance(sources[i], targets[target_of[i]]));
  }
  return longest;
}

}  // namespace

std::optional<Assignment> assign(std::span<const Point> sources, std::span<const Point> targets, WalkCost cost,
                                 double longest_m, const std::atomic<bool>* stop) {
  FL_CHECK(sources.size() == targets.size());
  FL_CHECK(longest_m >= 0);
  if (cost == WalkCost::euclidean) {
    // Without a longest walk whoever stands on a target may stay there, and if nobody walks too far then, that was it.
    auto free = assign_where_common_points_stay(sources, targets, stop);
    if (!free || longest_walk(sources, targets, free->target_of) <= longest_m) return free;
  }
  return assign_all(sources, targets, cost, longest_m, stop);
}

std::optional<Assignment> assign_sparse(std::uint32_t size, std::span<const Arc> arcs) {
  double widest = 0;
  for (std::size_t e = 0; e < arcs.size(); ++e) {
    FL_CHECK(arcs[e].source < size && arcs[e].target < size && std::isfinite(arcs[e].cost));
    FL_CHECK(e == 0 || std::pair(arcs[e - 1].source, arcs[e - 1].target) < std::pair(arcs[e].source, arcs[e].target));
    widest = std::max(widest, std::abs(arcs[e].cost));
  }
  const int bits = 60 - static_cast<int>(std::bit_width(size));
  const double scale = std::ldexp(1.0, std::clamp(bits - (widest > 0 ? std::ilogb(widest) + 1 : 0), -200, 200));
  ArcRows rows;
  std::size_t e = 0;
  for (std::uint32_t i = 0; i < size; ++i) {
    for (; e < arcs.size() && arcs[e].source == i; ++e) {
      rows.add(arcs[e].target, static_cast<Value>(std::nearbyint(arcs[e].cost * scale)));
    }
    rows.close_row();
  }
  Matching matching;
  matching.price.assign(size, 0);
  matching.target_of.assign(size, assignment::kNobody);
  hold_auctions(rows, static_cast<Value>(widest * scale), matching);
  Phases phases(rows, matching, false);
  phases.tighten();
  if (phases.run({}) != Phases::Outcome::perfect) return std::nullopt;
  Assignment result;
  result.looked_at = phases.looked_at();
  result.target_of = matching.target_of;
  Value primal = 0;
  Value dual = 0;
  for (std::uint32_t i = 0; i < size; ++i) {
    result.source_value.push_back(static_cast<double>(matching.value[i]) / scale);
    result.target_value.push_back(-static_cast<double>(matching.price[i]) / scale);
    const auto arc = std::ranges::lower_bound(arcs, std::pair(i, matching.target_of[i]), {},
                                              [](const Arc& a) { return std::pair(a.source, a.target); });
    result.cost += arc->cost;
    primal += static_cast<Value>(std::nearbyint(arc->cost * scale));
    dual += matching.value[i] - matching.price[i];
  }
  result.gap = static_cast<double>(primal - dual) / scale;
  return result;
}

}  // namespace footlight::planner
