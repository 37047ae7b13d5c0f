// SPDX-License-Identifier: Apache-2.0
#include "planner/hierarchy/hierarchical_matching.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "core/check.hpp"
#include "planner/assignment/assignment.hpp"
#include "planner/hierarchy/regions.hpp"
#include "planner/hierarchy/transport.hpp"
#include "planner/repair/exchange.hpp"

namespace footlight::planner {
namespace {

using Positions = std::vector<std::uint32_t>;

/// The regions of each further division are so many times smaller.
constexpr int kDivision = 4;
/// More regions than this on a side are put together by a layer of their own: the transport between them is dense.
constexpr std::size_t kMostRegions = 300;

class Matcher {
 public:
  Matcher(const Grid& grid, std::span<const CellIndex> sources, std::span<const CellIndex> targets,
          const PlannerOptions& options)
      : grid_(grid), sources_(sources), targets_(targets), options_(options), target_of_(sources.size()) {}

  Positions run() {
    Positions everybody(sources_.size());
    std::iota(everybody.begin(), everybody.end(), 0U);
    int layers = options_.layers;
    RegionLimits limits{options_.region_size, options_.region_variance_m2};
    while (layers > 1 && everybody.size() > kMostRegions * static_cast<std::size_t>(limits.most_people)) {
      limits.most_people *= kDivision;
      limits.variance_m2 *= kDivision;
      ++layers;
    }
    match(everybody, everybody, layers, limits);
    return std::move(target_of_);
  }

 private:
  void match(const Positions& from, const Positions& to, int layers, const RegionLimits& limits) {
    if (layers <= 1 || static_cast<int>(from.size()) <= 3) {
      match_persons(from, to);
      return;
    }
    const auto from_regions = divide(sources_, from, limits);
    const auto to_regions = divide(targets_, to, limits);
    std::vector<Load> supply;
    std::vector<Load> demand;
    for (const Region& r : from_regions) supply.push_back({r.anchor, static_cast<int>(r.members.size())});
    for (const Region& r : to_regions) demand.push_back({r.anchor, static_cast<int>(r.members.size())});
    const auto shipments = transport(supply, demand, options_.cost);
    const auto leaving = split(sources_, from_regions, shipments, &Shipment::from, &Shipment::to, demand);
    const auto arriving = split(targets_, to_regions, shipments, &Shipment::to, &Shipment::from, supply);
    const RegionLimits next{std::max(1, limits.most_people / kDivision), limits.variance_m2 / kDivision};
    for (std::size_t s = 0; s < shipments.size(); ++s) match(leaving[s], arriving[s], layers - 1, next);
  }

  [[nodiscard]] std::vector<Region> divide(std::span<const CellIndex> cells, const Positions& part,
                                           const RegionLimits& limits) const {
    std::vector<CellIndex> here;
    here.reserve(part.size());
    for (const std::uint32_t i : part) here.push_back(cells[i]);
    auto regions = grow_regions(grid_, here, limits);
    for (Region& region : regions) {
      for (std::uint32_t& member : region.members) member = part[member];
    }
    return regions;
  }

  /// Which members of each region belong to which shipment: everybody near to the anchor of the other end, exactly.
  [[nodiscard]] std::vector<Positions> split(std::span<const CellIndex> cells, const std::vector<Region>& regions,
                                             const std::vector<Shipment>& shipments, std::uint32_t Shipment::*own,
                                             std::uint32_t Shipment::*other, const std::vector<Load>& others) const {
    std::vector<Positions> parts(shipments.size());
    std::vector<Positions> of_region(regions.size());
    for (std::uint32_t s = 0; s < shipments.size(); ++s) of_region[shipments[s].*own].push_back(s);
    for (std::size_t r = 0; r < regions.size(); ++r) {
      const Positions& members = regions[r].members;
      if (of_region[r].size() == 1) {
        parts[of_region[r].front()] = members;
        continue;
      }
      if (of_region[r].size() == 2) {
        split_in_two(cells, members, shipments, of_region[r], other, others, parts);
        continue;
      }
      Positions seats;  // the shipment of each seat
      for (const std::uint32_t s : of_region[r]) {
        seats.insert(seats.end(), static_cast<std::size_t>(shipments[s].people), s);
      }
      FL_CHECK(seats.size() == members.size());
      std::vector<Arc> arcs;
      arcs.reserve(seats.size() * seats.size());
      for (std::uint32_t m = 0; m < members.size(); ++m) {
        const Point place = grid_.centre(cells[members[m]]);
        for (std::uint32_t seat = 0; seat < seats.size(); ++seat) {
          const Point anchor = others[shipments[seats[seat]].*other].anchor;
          arcs.push_back({m, seat, pairing_cost(options_.cost, place, anchor)});
        }
      }
      const auto seated = assign_sparse(static_cast<std::uint32_t>(members.size()), arcs);
      FL_CHECK(seated.has_value());
      for (std::uint32_t m = 0; m < members.size(); ++m) parts[seats[seated->target_of[m]]].push_back(members[m]);
    }
    return parts;
  }

  /// Two ends only: whoever gains most by the first rather than the second goes there, which is exact.
  void split_in_two(std::span<const CellIndex> cells, const Positions& members, const std::vector<Shipment>& shipments,
                    const Positions& ends, std::uint32_t Shipment::*other, const std::vector<Load>& others,
                    std::vector<Positions>& parts) const {
    const Point first = others[shipments[ends[0]].*other].anchor;
    const Point second = others[shipments[ends[1]].*other].anchor;
    std::vector<std::pair<double, std::uint32_t>> order;
    for (const std::uint32_t member : members) {
      const Point place = grid_.centre(cells[member]);
      order.emplace_back(pairing_cost(options_.cost, place, first) - pairing_cost(options_.cost, place, second),
                         member);
    }
    std::sort(order.begin(), order.end());
    const auto to_first = static_cast<std::size_t>(shipments[ends[0]].people);
    FL_CHECK(to_first + static_cast<std::size_t>(shipments[ends[1]].people) == members.size());
    for (std::size_t n = 0; n < order.size(); ++n) parts[ends[n < to_first ? 0 : 1]].push_back(order[n].second);
  }

  void match_persons(const Positions& from, const Positions& to) {
    std::vector<Point> starts;
    std::vector<Point> goals;
    for (const std::uint32_t i : from) starts.push_back(grid_.centre(sources_[i]));
    for (const std::uint32_t j : to) goals.push_back(grid_.centre(targets_[j]));
    const WalkCost cost = options_.cost == PairingCost::squared ? WalkCost::squared : WalkCost::euclidean;
    const auto best = assign(starts, goals, cost, std::numeric_limits<double>::infinity());
    FL_CHECK(best.has_value());
    for (std::size_t i = 0; i < from.size(); ++i) target_of_[from[i]] = to[best->target_of[i]];
  }

  const Grid& grid_;
  std::span<const CellIndex> sources_;
  std::span<const CellIndex> targets_;
  const PlannerOptions& options_;
  Positions target_of_;
};

}  // namespace

std::vector<std::uint32_t> match_hierarchically(const Grid& grid, std::span<const CellIndex> sources,
                                                std::span<const CellIndex> targets, const PlannerOptions& options) {
  FL_CHECK(sources.size() == targets.size());
  std::vector<std::uint32_t> target_of = Matcher(grid, sources, targets, options).run();
  if (options.layers > 1) {
    std::vector<Point> starts;
    std::vector<Point> goals;
    for (const CellIndex cell : sources) starts.push_back(grid.centre(cell));
    for (const CellIndex cell : targets) goals.push_back(grid.centre(cell));
    exchange(starts, goals, target_of, grid.clearance_bound_m(), [](Point, Point) { return true; });
  }
  return target_of;
}

std::vector<std::uint32_t> pair_formations(const Grid& grid, std::span<const CellIndex> sources,
                                           std::span<const CellIndex> targets, const PlannerOptions& options) {
  PlannerOptions chosen = options;
  if (chosen.model == PlannerModel::flat) chosen.layers = 1;
  return match_hierarchically(grid, sources, targets, chosen);
}

}  // namespace footlight::planner
