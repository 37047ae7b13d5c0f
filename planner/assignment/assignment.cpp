// SPDX-License-Identifier: Apache-2.0
#include "planner/assignment/assignment.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "core/check.hpp"
#include "planner/assignment/auction.hpp"
#include "planner/assignment/match_walks.hpp"
#include "planner/assignment/phases.hpp"

namespace footlight::planner {
namespace {

using assignment::ArcRows;
using assignment::hold_auction;
using assignment::kNobody;
using assignment::match_walks;
using assignment::Matching;
using assignment::Phases;
using assignment::Value;
using assignment::Walks;

double walk_cost(Point a, Point b, WalkCost cost) {
  return cost == WalkCost::squared ? squared_length(a - b) : distance(a, b);
}

}  // namespace

std::optional<Assignment> assign(std::span<const Point> sources, std::span<const Point> targets, WalkCost cost,
                                 double longest_m) {
  FL_CHECK(sources.size() == targets.size());
  FL_CHECK(longest_m >= 0);
  const Walks walks(sources, targets, cost, longest_m);
  Assignment result;
  if (walks.size() == 0) return result;
  const auto matching = match_walks(walks);
  if (!matching) return std::nullopt;
  const std::uint32_t size = walks.size();
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
  matching.target_of.assign(size, kNobody);
  const auto most = static_cast<Value>(widest * scale);
  for (Value step = most / 8; step > most / 4096; step /= 5)
    hold_auction(rows, std::max<Value>(step, 1), 10ULL * size, matching);
  Phases phases(rows, matching, false);
  phases.tighten();
  if (!phases.run()) return std::nullopt;
  Assignment result;
  result.target_of = matching.target_of;
  double dual = 0;
  for (std::uint32_t i = 0; i < size; ++i) {
    result.source_value.push_back(static_cast<double>(matching.value[i]) / scale);
    result.target_value.push_back(-static_cast<double>(matching.price[i]) / scale);
    const auto arc = std::ranges::lower_bound(arcs, std::pair(i, matching.target_of[i]), {},
                                              [](const Arc& a) { return std::pair(a.source, a.target); });
    result.cost += arc->cost;
    dual += static_cast<double>(matching.value[i] - matching.price[i]) / scale;
  }
  result.gap = result.cost - dual;
  return result;
}

}  // namespace footlight::planner
