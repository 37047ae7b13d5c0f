// SPDX-License-Identifier: Apache-2.0
#include "planner/assignment/assignment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

#include "core/check.hpp"

namespace footlight::planner {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

double walk_cost(Point a, Point b, WalkCost cost) {
  return cost == WalkCost::squared ? squared_length(a - b) : distance(a, b);
}

/// Successive shortest augmenting paths with potentials over rows of arcs (Dijkstra's form, Edmonds and Karp 1972).
class SparseSearch {
 public:
  SparseSearch(std::uint32_t size, std::span<const Arc> arcs) : size_(size), arcs_(arcs), first_(size + 1, 0) {
    for (const Arc& arc : arcs) ++first_[arc.source + 1];
    for (std::uint32_t i = 0; i < size; ++i) first_[i + 1] += first_[i];
    price_.assign(size, kInfinity);
    for (const Arc& arc : arcs) price_[arc.target] = std::min(price_[arc.target], arc.cost);
    potential_.assign(size, 0);
    target_of_.assign(size, kNone);
    source_of_.assign(size, kNone);
    distance_.assign(size, kInfinity);
    reached_from_.assign(size, kNone);
  }

  std::optional<Assignment> solve() {
    for (std::uint32_t source = 0; source < size_; ++source) {
      if (!augment(source)) return std::nullopt;
    }
    Assignment result;
    double dual = 0;
    for (std::uint32_t source = 0; source < size_; ++source) {
      result.cost += matched_cost(source);
      dual += potential_[source] + price_[source];
    }
    result.target_of = target_of_;
    result.gap = result.cost - dual;
    return result;
  }

 private:
  double matched_cost(std::uint32_t source) const {
    const auto row = arcs_.subspan(first_[source], first_[source + 1] - first_[source]);
    return std::ranges::lower_bound(row, target_of_[source], {}, &Arc::target)->cost;
  }

  void relax(std::uint32_t source, double base) {
    for (std::uint32_t e = first_[source]; e < first_[source + 1]; ++e) {
      const Arc& arc = arcs_[e];
      const double reached = base + std::max(0.0, arc.cost - potential_[source] - price_[arc.target]);
      if (reached >= distance_[arc.target]) continue;
      if (distance_[arc.target] == kInfinity) touched_.push_back(arc.target);
      distance_[arc.target] = reached;
      reached_from_[arc.target] = source;
      queue_.emplace(reached, arc.target);
    }
  }

  bool augment(std::uint32_t start) {
    queue_ = {};
    touched_.clear();
    double least = kInfinity;
    for (std::uint32_t e = first_[start]; e < first_[start + 1]; ++e) {
      least = std::min(least, arcs_[e].cost - price_[arcs_[e].target]);
    }
    potential_[start] = least == kInfinity ? 0 : least;
    relax(start, 0);
    std::uint32_t end = kNone;
    while (!queue_.empty()) {
      const auto [reached, target] = queue_.top();
      queue_.pop();
      if (reached > distance_[target]) continue;
      if (source_of_[target] == kNone) {
        end = target;
        break;
      }
      relax(source_of_[target], reached);
    }
    if (end != kNone) apply(start, end);
    for (const std::uint32_t target : touched_) distance_[target] = kInfinity;
    return end != kNone;
  }

  void apply(std::uint32_t start, std::uint32_t end) {
    const double bound = distance_[end];
    for (const std::uint32_t target : touched_) {
      if (distance_[target] >= bound) continue;
      price_[target] -= bound - distance_[target];
      if (source_of_[target] != kNone) potential_[source_of_[target]] += bound - distance_[target];
    }
    potential_[start] += bound;
    for (std::uint32_t target = end; target != kNone;) {
      const std::uint32_t source = reached_from_[target];
      source_of_[target] = source;
      std::swap(target_of_[source], target);
      if (source == start) break;
    }
  }

  std::uint32_t size_;
  std::span<const Arc> arcs_;
  std::vector<std::uint32_t> first_;
  std::vector<double> price_;      ///< of a target
  std::vector<double> potential_;  ///< of a source
  std::vector<std::uint32_t> target_of_, source_of_, reached_from_, touched_;
  std::vector<double> distance_;
  std::priority_queue<std::pair<double, std::uint32_t>, std::vector<std::pair<double, std::uint32_t>>, std::greater<>>
      queue_;
};

}  // namespace

std::optional<Assignment> assign(std::span<const Point> sources, std::span<const Point> targets, WalkCost cost,
                                 double longest_m) {
  FL_CHECK(sources.size() == targets.size());
  FL_CHECK(longest_m >= 0);
  const auto size = static_cast<std::uint32_t>(sources.size());
  std::vector<Arc> arcs;
  for (std::uint32_t i = 0; i < size; ++i) {
    for (std::uint32_t j = 0; j < size; ++j) {
      if (distance(sources[i], targets[j]) <= longest_m)
        arcs.push_back({i, j, walk_cost(sources[i], targets[j], cost)});
    }
  }
  return assign_sparse(size, arcs);
}

std::optional<Assignment> assign_sparse(std::uint32_t size, std::span<const Arc> arcs) {
  for (const Arc& arc : arcs) FL_CHECK(arc.source < size && arc.target < size && std::isfinite(arc.cost));
  for (std::size_t e = 1; e < arcs.size(); ++e) {
    FL_CHECK(std::pair(arcs[e - 1].source, arcs[e - 1].target) < std::pair(arcs[e].source, arcs[e].target));
  }
  return SparseSearch(size, arcs).solve();
}

}  // namespace footlight::planner
