// SPDX-License-Identifier: Apache-2.0
// Labels of all nodes set at once from shortest ways through the residual network (Goldberg 1997, An efficient
// implementation of a scaling minimum-cost flow algorithm, section 5: price updates). Every node is two points, the way
// into it and the way out of it; ways that are taken can be taken back.
#include <algorithm>
#include <bit>

#include "planner/joint/time_flow.hpp"

namespace footlight::planner {
namespace {

/// Whatever is further away counts as this far, epsilons.
constexpr std::int32_t kFurthest = 4096;

}  // namespace

/// What divides by the epsilon without a division. The reciprocal is too large by less than 1, so that the quotient of
/// a whole cost below 2^31 is too large by less than 2^31 / 2^shift_ < 1 / epsilon: too little to reach the next
/// number.
void TimeFlowSolver::set_steps() {
  shift_ = 31U + static_cast<unsigned>(std::bit_width(static_cast<std::uint32_t>(epsilon_)));
  const auto divisor = static_cast<std::uint64_t>(epsilon_);
  reciprocal_ = ((std::uint64_t{1} << shift_) + divisor - 1) / divisor;
}

/// Length of a way that costs `cost` more than the labels say, epsilons: with labels changed by the distances it costs
/// between -1 and 0 more, on a shortest way.
inline std::int32_t TimeFlowSolver::steps(std::int32_t cost) const { return cost < 0 ? 0 : epsilons(cost) + 1; }

inline std::int32_t TimeFlowSolver::epsilons(std::int32_t cost) const {
  return static_cast<std::int32_t>((static_cast<std::uint64_t>(cost) * reciprocal_) >> shift_);
}

inline void TimeFlowSolver::put(std::uint32_t point, std::int32_t distance) {
  if (distance >= distance_[point]) return;
  distance_[point] = distance;
  if (static_cast<std::size_t>(distance) >= queue_.size()) queue_.resize(static_cast<std::size_t>(distance) + 1);
  queue_[static_cast<std::size_t>(distance)].push_back(point);
}

void TimeFlowSolver::forget_distances() { distance_.assign(2 * from_.size() + 1, kFurthest); }

/// Takes up points by distance until as many as `wanted` that settle(point, distance) says yes to are reached.
/// @return how far that was
template <class Settle>
std::int32_t TimeFlowSolver::settle_distances(std::size_t wanted, Settle settle) {
  std::int32_t furthest = 0;
  for (std::size_t d = 0; d < queue_.size() && wanted > 0; ++d) {
    furthest = static_cast<std::int32_t>(d);
    for (std::size_t n = 0; n < queue_[d].size(); ++n) {
      const std::uint32_t point = queue_[d][n];
      if (distance_[point] == furthest && settle(point, furthest)) --wanted;
    }
  }
  for (auto& points : queue_) points.clear();
  return wanted > 0 ? kFurthest : furthest;
}

void TimeFlowSolver::move_labels(std::int32_t furthest, std::int32_t step) {
  for (std::uint32_t v = 0; v < from_.size(); ++v) {
    if (out_[v] >= kFar / 2) continue;
    into_[v] += step * std::min(distance_[2 * v], furthest);
    out_[v] += step * std::min(distance_[2 * v + 1], furthest);
  }
  if (free_start_) start_label_ += step * std::min(distance_.back(), furthest);
}

/// Whoever has yet to choose gets labels at which she is on a cheapest way to the end, or to a node that waits for
/// somebody.
void TimeFlowSolver::raise_labels() {
  const auto source = static_cast<std::uint32_t>(2 * from_.size());
  forget_distances();
  std::size_t bidders = waiting_ > 0 ? 1 : 0;
  for (std::uint32_t v = 0; v < from_.size(); ++v) {
    bidders += is_bidder(v) ? 1 : 0;
    if (from_[v] == kUnfilled) reach_in(v, 0);
    if (v >= node(last_, 0) && out_[v] < kFar / 2) reach_out(v, 0);
  }
  if (waiting_ > 0 && start_label_ == -kFar) start_label_ = *std::min_element(into_.begin(), into_.begin() + cells_);
  const std::int32_t furthest = settle_distances(bidders, [&](std::uint32_t point, std::int32_t distance) {
    ways_into(point, distance);
    return point == source ? waiting_ > 0 : (point & 1U) != 0 && is_bidder(point / 2);
  });
  move_labels(furthest, epsilon_);
  if (free_start_) offer_starts();
}

/// From where a point at a distance from the end can be reached.
void TimeFlowSolver::ways_into(std::uint32_t point, std::int32_t distance) {
  const std::uint32_t at = point / 2;
  if (at == from_.size()) {
    for (std::uint32_t c = 0; c < cells_; ++c) {
      if (from_[c] == kSource) reach_in(c, distance + steps(start_label_ - into_[c]));
    }
    return;
  }
  if ((point & 1U) != 0) {
    if (from_[at] == kEmpty) return reach_in(at, distance);
    const std::uint32_t to = next_[at];
    if (to != kNone) reach_in(to, distance + steps(out_[at] - task_.stand[at] - walk_to(to) - into_[to]));
    return;
  }
  if (from_[at] != kEmpty) reach_out(at, distance + epsilons(std::max(0, into_[at] - out_[at])));
  if (at < cells_) {
    if (free_start_ && from_[at] != kSource) reach_source(distance + steps(into_[at] - start_label_));
    return;
  }
  const std::uint32_t k = at / cells_ - 1;
  const FlowInterval& interval = task_.intervals[k];
  const Reach& reach = *interval.reach;
  const std::uint32_t c = at - (k + 1) * cells_;
  const std::int32_t* known = distance_.data();
  const std::int32_t* stand = task_.stand.data();
  const std::int32_t* out = out_.data();
  const std::int32_t into = into_[at];
  for (std::uint32_t a = reach.first[c]; a < reach.first[c + 1]; ++a) {
    const std::uint32_t u = node(k, reach.to[a]);
    if (known[2 * u + 1] <= distance) continue;
    reach_out(u, distance + steps(stand[u] + interval.cost[reach.mirror[reach.kind[a]]] + into - out[u]));
  }
}

/// Nodes that wait for somebody come down to where somebody would come, or where they are better left empty.
void TimeFlowSolver::lower_labels() {
  forget_distances();
  std::size_t unfilled = 0;
  for (std::uint32_t v = 0; v < from_.size(); ++v) {
    unfilled += from_[v] == kUnfilled ? 1 : 0;
    if (v >= node(last_, 0) && from_[v] != kEmpty) reach_out(v, 0);
  }
  const std::int32_t furthest = settle_distances(unfilled, [&](std::uint32_t point, std::int32_t distance) {
    ways_out_of(point, distance);
    return (point & 1U) == 0 && point / 2 < from_.size() && from_[point / 2] == kUnfilled;
  });
  move_labels(furthest, -epsilon_);
}

/// Where one gets from a point at a distance from the end, taking ways back.
void TimeFlowSolver::ways_out_of(std::uint32_t point, std::int32_t distance) {
  const std::uint32_t at = point / 2;
  if (at == from_.size()) {
    for (std::uint32_t c = 0; c < cells_; ++c) {
      if (from_[c] != kSource && out_[c] < kFar / 2) reach_in(c, distance + steps(into_[c] - start_label_));
    }
    return;
  }
  if ((point & 1U) == 0) {
    const std::uint32_t before = from_[at];
    if (before == kEmpty) return reach_out(at, distance);
    if (before == kSource && free_start_) return reach_source(distance + steps(start_label_ - into_[at]));
    if (!is_node(before)) return;
    return reach_out(before, distance + steps(out_[before] - task_.stand[before] - walk_to(at) - into_[at]));
  }
  if (from_[at] != kEmpty) reach_in(at, distance + epsilons(std::max(0, into_[at] - out_[at])));
  const std::uint32_t k = at / cells_;
  if (k == last_) return;
  const FlowInterval& interval = task_.intervals[k];
  const Reach& reach = *interval.reach;
  const std::uint32_t c = at - k * cells_;
  for (std::uint32_t a = reach.first[c]; a < reach.first[c + 1]; ++a) {
    const std::uint32_t w = node(k + 1, reach.to[a]);
    if (distance_[2 * w] <= distance) continue;
    reach_in(w, distance + steps(task_.stand[at] + interval.cost[reach.kind[a]] + into_[w] - out_[at]));
  }
}

}  // namespace footlight::planner
