// SPDX-License-Identifier: Apache-2.0
#include "planner/collective/pairing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "core/check.hpp"
#include "planner/assignment/assignment.hpp"
#include "planner/formation/delaunay.hpp"

namespace footlight::planner::collective {
namespace {

/// Likely pairs of each person to begin with, by cost and by cost of shape.
constexpr std::size_t kLikely = 12;
/// Pairs that one person may get in one round.
constexpr std::size_t kMostNew = 24;
/// A pair is too cheap when it is below the dual solution by more than this share of the dearest likely pair.
constexpr double kRounding = 1e-12;

Point middle(std::span<const Point> points) {
  Point sum;
  for (const Point p : points) sum = sum + p;
  return points.empty() ? sum : 1 / static_cast<double>(points.size()) * sum;
}

template <class Work>
void for_each_person(std::uint32_t people, Work work) {
  tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, people, 16), [&](const auto& range) {
    for (std::uint32_t i = range.begin(); i != range.end(); ++i) work(i);
  });
}

using Row = std::vector<Arc>;

/// The `most` cheapest places of a person by two orders, without those that cannot be reached.
Row likely_places(const PairCosts& costs, std::uint32_t person, std::size_t most) {
  Row row;
  std::vector<std::pair<double, std::uint32_t>> order(costs.size());
  for (const bool shape : {false, true}) {
    for (std::uint32_t j = 0; j < costs.size(); ++j) {
      order[j] = {shape ? costs.cost_of_shape(person, j) : costs.cost(person, j), j};
    }
    const auto end = order.begin() + static_cast<std::ptrdiff_t>(std::min(most, order.size()));
    std::partial_sort(order.begin(), end, order.end());
    for (auto it = order.begin(); it != end; ++it) {
      const double cost = costs.cost(person, it->second);
      if (std::isfinite(cost)) row.push_back({person, it->second, cost});
    }
  }
  return row;
}

void sort_row(Row& row) {
  std::sort(row.begin(), row.end(), [](const Arc& a, const Arc& b) { return a.target < b.target; });
  row.erase(std::unique(row.begin(), row.end(), [](const Arc& a, const Arc& b) { return a.target == b.target; }),
            row.end());
}

std::vector<Arc> joined(const std::vector<Row>& rows) {
  std::vector<Arc> arcs;
  for (const Row& row : rows) arcs.insert(arcs.end(), row.begin(), row.end());
  return arcs;
}

/// Pairs that the dual solution finds cheaper than it allows, the cheapest first. @return whether there are none
bool add_too_cheap(const PairCosts& costs, const Assignment& found, double slack, std::vector<Row>& rows) {
  std::vector<char> complete(costs.size(), 1);
  for_each_person(costs.size(), [&](std::uint32_t i) {
    std::vector<std::pair<double, Arc>> cheap;
    for (std::uint32_t j = 0; j < costs.size(); ++j) {
      const double cost = costs.cost(i, j);
      const double reduced = cost - found.source_value[i] - found.target_value[j];
      if (reduced < -slack) cheap.push_back({reduced, {i, j, cost}});
    }
    if (cheap.empty()) return;
    complete[i] = 0;
    std::sort(cheap.begin(), cheap.end(), [](const auto& a, const auto& b) {
      return std::tuple(a.first, a.second.target) < std::tuple(b.first, b.second.target);
    });
    if (cheap.size() > kMostNew) cheap.resize(kMostNew);
    for (const auto& [reduced, arc] : cheap) rows[i].push_back(arc);
    sort_row(rows[i]);
  });
  return std::find(complete.begin(), complete.end(), 0) == complete.end();
}

/// How much longer the way around is than the straight one, for each person and place.
std::vector<float> stretches(const PairingTask& task) {
  const WalkField& around = *task.around;
  const auto people = static_cast<std::uint32_t>(task.from.size());
  std::vector<float> stretch(std::size_t{people} * people);
  for_each_person(people, [&](std::uint32_t place) {
    if (task.stop != nullptr && task.stop->load(std::memory_order_relaxed)) return;
    const std::vector<float> away = around.to(around.cell_at(task.to[place]));
    for (std::uint32_t i = 0; i < people; ++i) {
      const double straight_m = distance(task.from[i], task.to[place]);
      const double length_m = around.length_m(away[around.cell_at(task.from[i]).at()], straight_m);
      const double times = straight_m > 0 ? length_m / straight_m : 1;
      stretch[std::size_t{i} * people + place] = static_cast<float>(times);
    }
  });
  return stretch;
}

}  // namespace

std::vector<double> mean_edges_m(std::span<const Point> points) {
  std::vector<double> sum(points.size(), 0);
  std::vector<double> edges(points.size(), 0);
  for (const DelaunayEdge edge : delaunay_edges(points)) {
    const double long_m = distance(points[edge.a], points[edge.b]);
    for (const std::uint32_t end : {edge.a, edge.b}) {
      sum[end] += long_m;
      ++edges[end];
    }
  }
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = edges[i] > 0 ? sum[i] / edges[i] : 0;
  return sum;
}

PairCosts::PairCosts(const PairingTask& task, const CollectiveOptions& options)
    : from_(task.from.begin(), task.from.end()),
      to_(task.to.begin(), task.to.end()),
      radius_m_(task.radius_m.begin(), task.radius_m.end()),
      kind_(options.pairing),
      lambda_(options.lambda),
      shift_(middle(from_) - middle(to_)) {
  FL_CHECK(from_.size() == to_.size() && radius_m_.size() == from_.size() && task.speed_mps.size() == from_.size());
  double fastest = 0;
  for (const double speed : task.speed_mps) fastest = std::max(fastest, speed);
  for (const double speed : task.speed_mps) slowness_.push_back(fastest / speed);
  if (kind_ == CollectiveOptions::Pairing::least_effort) {
    from_edges_m_ = mean_edges_m(from_);
    to_edges_m_ = mean_edges_m(to_);
  }
  if (task.around != nullptr && from_.size() <= kMostAround) stretch_ = stretches(task);
}

double PairCosts::cost_of(std::uint32_t person, std::uint32_t place, Point from, Point to) const {
  const Point way = to - from;
  const double times =
      slowness_[person] * (stretch_.empty() ? 1 : double{stretch_[std::size_t{person} * size() + place]});
  if (kind_ == CollectiveOptions::Pairing::manhattan) return (std::abs(way.x) + std::abs(way.y)) * times;
  if (kind_ == CollectiveOptions::Pairing::euclidean) return length(way) * times;
  const double density = from_edges_m_[person] - to_edges_m_[place];
  const double squeezed = std::max(0.0, 2 * radius_m_[person] - to_edges_m_[place]);
  return lambda_ * squared_length(way) * times * times + (1 - lambda_) * (density * density + squeezed * squeezed);
}

std::optional<Pairing> find_pairing(const PairCosts& costs, const std::atomic<bool>* stop) {
  const auto stopped = [&] { return stop != nullptr && stop->load(std::memory_order_relaxed); };
  const std::uint32_t people = costs.size();
  Pairing out;
  if (people == 0) return out;
  std::vector<Row> rows(people);
  std::optional<Assignment> found;
  for (std::size_t likely = kLikely;; likely *= 4) {
    for_each_person(people, [&](std::uint32_t i) {
      rows[i] = likely_places(costs, i, likely);
      sort_row(rows[i]);
    });
    if (stopped()) return std::nullopt;
    found = assign_sparse(people, joined(rows));
    if (found || likely >= people) break;
    ++out.widened;
  }
  while (found) {
    double dearest = 0;
    for (const Row& row : rows) {
      for (const Arc& arc : row) dearest = std::max(dearest, arc.cost);
    }
    if (stopped()) return std::nullopt;
    if (add_too_cheap(costs, *found, kRounding * dearest * static_cast<double>(people), rows)) break;
    ++out.widened;
    found = assign_sparse(people, joined(rows));
  }
  if (!found) return std::nullopt;
  out.place_of = found->target_of;
  out.cost = found->cost;
  out.gap = found->gap;
  return out;
}

}  // namespace footlight::planner::collective
