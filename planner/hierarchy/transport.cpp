// SPDX-License-Identifier: Apache-2.0
#include "planner/hierarchy/transport.hpp"

#include <algorithm>
#include <limits>

#include "core/check.hpp"

namespace footlight::planner {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

/// Residual network of a dense transport problem. Nodes 0..R-1 are sources, R..R+S-1 are targets.
class Network {
 public:
  Network(std::span<const Load> from, std::span<const Load> to, PairingCost cost)
      : rows_(from.size()), columns_(to.size()), cost_(rows_ * columns_), flow_(rows_ * columns_, 0) {
    for (std::size_t i = 0; i < rows_; ++i) {
      supply_.push_back(from[i].people);
      for (std::size_t j = 0; j < columns_; ++j) {
        cost_[i * columns_ + j] = pairing_cost(cost, from[i].anchor, to[j].anchor);
      }
    }
    for (const Load& load : to) demand_.push_back(load.people);
    potential_.assign(rows_ + columns_, 0.0);
    send_where_nothing_is_cheaper();
  }

  /// Sends people along the cheapest path from any source with supply to any target with demand.
  bool augment() {
    const std::size_t end = shortest_path();
    if (end == rows_ + columns_) return false;
    int people = demand_[end - rows_];
    std::size_t node = end;
    for (; before_[node] != node; node = before_[node]) {
      if (node < rows_) people = std::min(people, flow_[node * columns_ + before_[node] - rows_]);
    }
    people = std::min(people, supply_[node]);
    supply_[node] -= people;
    demand_[end - rows_] -= people;
    for (node = end; before_[node] != node; node = before_[node]) {
      if (node >= rows_) {
        flow_[before_[node] * columns_ + node - rows_] += people;
      } else {
        flow_[node * columns_ + before_[node] - rows_] -= people;
      }
    }
    return true;
  }

  [[nodiscard]] std::vector<Shipment> shipments() const {
    std::vector<Shipment> out;
    for (std::size_t i = 0; i < rows_; ++i) {
      for (std::size_t j = 0; j < columns_; ++j) {
        const int people = flow_[i * columns_ + j];
        if (people > 0) out.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j), people});
      }
    }
    return out;
  }

 private:
  /// Prices under which every region has an end that costs nothing more; most people can go there at once.
  void send_where_nothing_is_cheaper() {
    for (std::size_t i = 0; i < rows_; ++i) {
      potential_[i] = -*std::min_element(cost_.begin() + static_cast<std::ptrdiff_t>(i * columns_),
                                         cost_.begin() + static_cast<std::ptrdiff_t>((i + 1) * columns_));
    }
    for (std::size_t j = 0; j < columns_; ++j) {
      double least = kFar;
      for (std::size_t i = 0; i < rows_; ++i) least = std::min(least, cost_[i * columns_ + j] + potential_[i]);
      potential_[rows_ + j] = least;
    }
    for (std::size_t i = 0; i < rows_; ++i) {
      for (std::size_t j = 0; j < columns_; ++j) {
        if (cost_[i * columns_ + j] + potential_[i] > potential_[rows_ + j]) continue;
        const int people = std::min(supply_[i], demand_[j]);
        flow_[i * columns_ + j] = people;
        supply_[i] -= people;
        demand_[j] -= people;
      }
    }
  }

  /// Dijkstra over reduced costs up to the first target with demand. @return that node, or rows_ + columns_
  std::size_t shortest_path() {
    const std::size_t nodes = rows_ + columns_;
    std::vector<double> distance(nodes, kFar);
    std::vector<char> done(nodes, 0);
    before_.assign(nodes, nodes);
    for (std::size_t i = 0; i < rows_; ++i) {
      if (supply_[i] == 0) continue;
      distance[i] = 0;
      before_[i] = i;
    }
    for (;;) {
      std::size_t node = nodes;
      for (std::size_t i = 0; i < nodes; ++i) {
        if (done[i] == 0 && distance[i] < kFar && (node == nodes || distance[i] < distance[node])) node = i;
      }
      if (node == nodes) return nodes;
      done[node] = 1;
      if (node >= rows_ && demand_[node - rows_] > 0) {
        for (std::size_t i = 0; i < nodes; ++i) potential_[i] += std::min(distance[i], distance[node]);
        return node;
      }
      if (node < rows_) {
        for (std::size_t j = 0; j < columns_; ++j) relax(node, rows_ + j, cost_[node * columns_ + j], distance, done);
      } else {
        for (std::size_t i = 0; i < rows_; ++i) {
          const std::size_t arc = i * columns_ + node - rows_;
          if (flow_[arc] > 0) relax(node, i, -cost_[arc], distance, done);
        }
      }
    }
  }

  void relax(std::size_t from, std::size_t to, double cost, std::vector<double>& distance,
             const std::vector<char>& done) {
    if (done[to] != 0) return;
    const double there = distance[from] + std::max(0.0, cost + potential_[from] - potential_[to]);
    if (there < distance[to]) {
      distance[to] = there;
      before_[to] = from;
    }
  }

  std::size_t rows_;
  std::size_t columns_;
  std::vector<double> cost_;
  std::vector<int> flow_;
  std::vector<int> supply_;
  std::vector<int> demand_;
  std::vector<double> potential_;
  std::vector<std::size_t> before_;  // node before on the path; itself at its start
};

}  // namespace

double pairing_cost(PairingCost cost, Point a, Point b) {
  return cost == PairingCost::squared ? squared_length(a - b) : distance(a, b);
}

std::vector<Shipment> transport(std::span<const Load> from, std::span<const Load> to, PairingCost cost) {
  Network network(from, to, cost);
  while (network.augment()) {
  }
  return network.shipments();
}

}  // namespace footlight::planner
