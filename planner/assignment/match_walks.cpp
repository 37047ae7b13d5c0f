// SPDX-License-Identifier: Apache-2.0
#include "planner/assignment/match_walks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/check.hpp"
#include "planner/assignment/dense.hpp"
#include "planner/assignment/phases.hpp"
#include "planner/assignment/price_tree.hpp"
#include "planner/assignment/walk_auction.hpp"

namespace footlight::planner::assignment {
namespace {

constexpr std::uint32_t kDenseSize = 64;
constexpr std::uint32_t kMostCandidates = 48;
constexpr std::uint64_t kMostBids = 60;  ///< a source, in one phase of an auction
/// Under a longest walk, arcs for each source that the exact finish looks at before it gives up: five times of what a
/// hundred thousand people need whose longest walk becomes shorter by a third.
constexpr std::uint64_t kMostLookedAt = 20'000;
constexpr Value kMostMargins = Value{1} << 14U;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// The tree over the targets of some walks, priced in integers.
class PricedTargets {
 public:
  explicit PricedTargets(const Walks& walks)
      : walks_(walks), tree_(walks.targets().search_x, walks.targets().search_y, walks.metric()), finds_(tree_) {}

  void fit(std::span<const Value> prices, std::span<const std::uint32_t> without = {}) {
    shown_.resize(prices.size());
    base_ = *std::ranges::min_element(prices);
    for (std::size_t s = 0; s < prices.size(); ++s) {
      shown_[s] = static_cast<float>(static_cast<double>(prices[s] - base_) / walks_.scale());
    }
    for (const std::uint32_t s : without) shown_[s] = kInfinity;
    tree_.fit(shown_);
  }

  [[nodiscard]] PriceTree& tree() { return tree_; }
  /// The tree's prices, which an auction has raised.
  [[nodiscard]] std::vector<Value> prices() const {
    std::vector<Value> prices(walks_.size());
    for (std::uint32_t s = 0; s < walks_.size(); ++s) {
      prices[s] = base_ + nearest_value(static_cast<double>(tree_.price(s)) * walks_.scale());
    }
    return prices;
  }

  /// Candidates within `margin` of the best of a source, at most kMostCandidates and those the best.
  std::span<const Hit> best(std::uint32_t source, Value margin, std::uint32_t guess = kNobody) {
    const float x = walks_.sources().search_x[source];
    const float y = walks_.sources().search_y[source];
    const float bound = guess == kNobody ? kInfinity : tree_.value(x, y, guess) + to_search(margin) + tree_.rounding();
    tree_.collect({x, y, bound, to_search(margin), walks_.reach(), kMostCandidates}, finds_);
    return finds_.hits();
  }

  /// All targets of less than `value`, and some that are a little above.
  std::span<const Hit> below(std::uint32_t source, Value value) {
    const float bound = to_search(value - base_) - to_search(1) / 2 + tree_.rounding();
    tree_.collect(
        {walks_.sources().search_x[source], walks_.sources().search_y[source], bound, kInfinity, walks_.reach()},
        finds_);
    return finds_.hits();
  }

  /// All targets that are not too far, and some that are a little farther.
  std::span<const Hit> within_reach(std::uint32_t source) {
    tree_.collect(
        {walks_.sources().search_x[source], walks_.sources().search_y[source], kInfinity, kInfinity, walks_.reach()},
        finds_);
    return finds_.hits();
  }

  [[nodiscard]] float to_search(Value value) const {
    return static_cast<float>(static_cast<double>(value) / walks_.scale());
  }

 private:
  const Walks& walks_;
  PriceTree tree_;
  std::vector<float> shown_;
  Value base_ = 0;
  PriceTree::Finds finds_;
};

ArcRows candidates(const Walks& walks, PricedTargets& targets, const Matching& matching, Value margin) {
  ArcRows rows;
  rows.first.reserve(walks.size() + 1);
  for (std::uint32_t i = 0; i < walks.size(); ++i) {
    std::uint32_t kept = matching.target_of[i];
    for (const auto& hit : targets.best(i, margin, matching.target_of[i])) {
      if (walks.limited() && !walks.allowed(i, hit.target)) continue;
      rows.add(hit.target, walks.cost(i, hit.target));
      if (hit.target == kept) kept = kNobody;
    }
    if (kept != kNobody && (!walks.limited() || walks.allowed(i, kept))) rows.add(kept, walks.cost(i, kept));
    rows.close_row();
  }
  return rows;
}

/// Prices of fours of targets, carried over to each of the four: what the matched four would pay for it.
std::vector<Value> extend(const Walks& walks, const Walks& coarse, const Matching& sample) {
  const auto walk = [&](std::uint32_t four, std::uint32_t target) {
    const double dx = coarse.sources().search_x[four] - walks.targets().search_x[target];
    const double dy = coarse.sources().search_y[four] - walks.targets().search_y[target];
    const double squared = dx * dx + dy * dy;
    return nearest_value((walks.metric() == WalkCost::squared ? squared : std::sqrt(squared)) * walks.scale());
  };
  std::vector<Value> prices(walks.size());
  for (std::uint32_t s = 0; s < walks.size(); ++s) {
    const std::uint32_t near = std::min(s / 4, coarse.size() - 1);
    const std::uint32_t source = sample.source_of[near];
    prices[s] = sample.price[near];
    if (source != kNobody) prices[s] += coarse.cost(source, near) - walk(source, s);
  }
  return prices;
}

Matching match_all_pairs(const Walks& walks) {
  const std::uint32_t size = walks.size();
  CostTable costs(size);
  for (std::uint32_t i = 0; i < size; ++i) {
    double* row = costs.row(i);
    for (std::uint32_t s = 0; s < size; ++s) {
      if (!walks.limited() || walks.allowed(i, s)) row[s] = static_cast<double>(walks.cost(i, s));
    }
  }
  return match_dense(costs);
}

/// Steps and margins in units of Walks::spacing, found by trial on formations of performers. Distances are nearly
/// linear along a ray, so that far more targets are nearly as good as the best, and finer steps pay.
struct Tuning {
  std::vector<double> sample_steps;  ///< of the auctions of fours
  std::vector<double> steps;         ///< of the auctions of all
  float margin;                      ///< of the short lists there
  double arc_margin;                 ///< of the arcs for the exact finish
};

const Tuning& tuning(WalkCost metric) {
  static const Tuning squared{{4, 1, 0.25}, {1}, 8, 4};
  static const Tuning euclidean{{0.5, 0.1, 0.02}, {0.03, 0.004}, 0.12F, 0.02};
  return metric == WalkCost::squared ? squared : euclidean;
}

Matching auction(const Walks& walks, PricedTargets& targets, std::span<const double> steps) {
  const float spacing = targets.to_search(walks.spacing());
  WalkAuction auction(walks, targets.tree(), tuning(walks.metric()).margin * spacing);
  for (const double step : steps) {
    const bool sold_out =
        auction.hold(std::max(static_cast<float>(step) * spacing, targets.tree().rounding()), kMostBids * walks.size());
    if (!sold_out) break;  // who is left is the exact method's business
  }
  return {auction.target_of(), auction.source_of(), targets.prices(), {}};
}

/// Auction prices of fours of fours; the finest auction is left to the caller.
Matching sample_match(const Walks& walks) {
  if (walks.size() <= kDenseSize) return match_all_pairs(walks);
  const Walks coarse = walks.fours();
  PricedTargets targets(walks);
  targets.fit(extend(walks, coarse, sample_match(coarse)));
  return auction(walks, targets, tuning(walks.metric()).sample_steps);
}

/// Targets outside of the reached ones, for everybody who was reached.
std::vector<ArcRows::NewArc> arcs_out(const Walks& walks, PricedTargets& targets, const Matching& matching,
                                      const Phases& phases, Value margin) {
  std::vector<std::uint32_t> sources(phases.reached_sources().begin(), phases.reached_sources().end());
  std::ranges::sort(sources);
  targets.fit(matching.price, phases.reached_targets());
  std::vector<ArcRows::NewArc> arcs;
  const auto take = [&](std::uint32_t i, std::span<const Hit> hits) {
    for (const auto& hit : hits) {
      if (hit.value == kInfinity) continue;
      if (!walks.limited() || walks.allowed(i, hit.target)) arcs.push_back({i, hit.target, walks.cost(i, hit.target)});
    }
  };
  for (const std::uint32_t i : sources) take(i, targets.best(i, margin));
  // A search takes in a little more than the longest walk, which may hide what is allowed and dearer.
  if (arcs.empty() && walks.limited()) {
    for (const std::uint32_t i : sources) take(i, targets.within_reach(i));
  }
  return arcs;
}

/// Prices every allowed walk; those that would undercut the dual solution.
std::vector<ArcRows::NewArc> arcs_that_undercut(const Walks& walks, PricedTargets& targets, const Matching& matching) {
  targets.fit(matching.price);
  std::vector<ArcRows::NewArc> arcs;
  for (std::uint32_t i = 0; i < walks.size(); ++i) {
    for (const auto& hit : targets.below(i, matching.value[i])) {
      const Value cost = walks.cost(i, hit.target);
      if (cost + matching.price[hit.target] >= matching.value[i]) continue;
      if (!walks.limited() || walks.allowed(i, hit.target)) arcs.push_back({i, hit.target, cost});
    }
  }
  return arcs;
}

/// From prices and a matching that are nearly right to those that are. Sources that reach fewer targets than they are
/// get arcs out of what they reach; when no allowed walk leads out of it there is no matching (Hall 1935).
std::optional<Matching> finish(const Walks& walks, PricedTargets& targets, Matching matching, ArcRows rows,
                               const std::atomic<bool>* stop) {
  Patience patience;
  patience.stop = stop;
  if (walks.limited()) patience.most_arcs = kMostLookedAt * walks.size();
  Phases phases(rows, matching, walks.on_lattice());
  phases.tighten();
  // Each time it is looked twice as far, or a walk that is missing far away would take thousands of rounds.
  Value margin = 4 * walks.spacing();
  while (true) {
    Phases::Outcome outcome = phases.run(patience);
    for (; outcome == Phases::Outcome::stuck; outcome = phases.run(patience)) {
      const auto arcs = arcs_out(walks, targets, matching, phases, margin);
      if (arcs.empty()) return std::nullopt;
      phases.add(arcs);
      margin = std::min(2 * margin, kMostMargins * walks.spacing());
    }
    if (outcome == Phases::Outcome::given_up) return std::nullopt;
    const auto arcs = arcs_that_undercut(walks, targets, matching);
    matching.looked_at = phases.looked_at();
    if (arcs.empty()) return matching;
    phases.add(arcs);
  }
}

/// The cheapest matching of fours under the same longest walk, where it binds: near it prices rise so steeply, and from
/// so far away, that those of unlimited walks are no start. Where fours have none, those will have to do.
Matching sample_match_limited(const Walks& walks, const std::atomic<bool>* stop) {
  if (auto sample = match_walks(walks.fours(), stop)) return *std::move(sample);
  return sample_match(walks.unlimited().fours());
}

}  // namespace

std::optional<Matching> match_walks(const Walks& walks, const std::atomic<bool>* stop) {
  if (walks.size() <= kDenseSize) {
    Matching matching = match_all_pairs(walks);
    if (std::ranges::find(matching.target_of, kNobody) != matching.target_of.end()) return std::nullopt;
    return matching;
  }
  const Walks coarse = walks.unlimited().fours();
  PricedTargets targets(walks);
  targets.fit(extend(walks, coarse, sample_match(coarse)));
  Matching matching = auction(walks, targets, tuning(walks.metric()).steps);
  if (walks.limited() && std::ranges::find(matching.target_of, kNobody) != matching.target_of.end()) {
    targets.fit(extend(walks, walks.fours(), sample_match_limited(walks, stop)));
    matching = auction(walks, targets, tuning(walks.metric()).steps);
  }
  targets.fit(matching.price);
  const auto margin = static_cast<Value>(tuning(walks.metric()).arc_margin * static_cast<double>(walks.spacing()));
  ArcRows rows = candidates(walks, targets, matching, margin);
  return finish(walks, targets, std::move(matching), std::move(rows), stop);
}

}  // namespace footlight::planner::assignment
