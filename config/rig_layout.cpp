// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <numeric>

#include "config/device_profile.hpp"
#include "config/rig_file.hpp"
#include "core/check.hpp"

namespace footlight::config {
namespace {

/// How many of `nodes` each bus gets: in proportion to its capacity (largest remainder), one for each bus at least
/// where there are enough.
std::vector<int> shares(int nodes, const std::vector<int>& capacities) {
  const int total = std::accumulate(capacities.begin(), capacities.end(), 0);
  FL_CHECK(nodes <= total);
  std::vector<int> out(capacities.size());
  std::vector<std::size_t> order(capacities.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto remainder = [&](std::size_t b) { return static_cast<std::int64_t>(nodes) * capacities[b] % total; };
  int left = nodes;
  for (std::size_t b = 0; b < capacities.size(); ++b) {
    out[b] = static_cast<int>(static_cast<std::int64_t>(nodes) * capacities[b] / total);
    left -= out[b];
  }
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return remainder(a) > remainder(b); });
  for (std::size_t k = 0; k < order.size() && left > 0; ++k, --left) ++out[order[k]];
  for (std::size_t b = 0; b < out.size() && nodes >= static_cast<int>(out.size()); ++b) {
    if (out[b] > 0 || capacities[b] == 0) continue;
    --*std::max_element(out.begin(), out.end());
    out[b] = 1;
  }
  return out;
}

/// Lamps of all cells that are not blocked, in order, then of all wearables.
std::vector<Channel> all_lamps(const Show& show) {
  std::vector<Channel> out;
  const auto& blocked = show.stage.blocked;
  for (int c = 0; c < show.stage.grid.size(); ++c) {
    const CellIndex cell = CellIndex::of(c);
    if (!std::binary_search(blocked.begin(), blocked.end(), cell)) out.push_back({Channel::Kind::cell, cell, {}});
  }
  for (std::size_t p = 0; p < show.performers.size(); ++p) {
    if (!show.performers[p].wearable.empty()) out.push_back({Channel::Kind::wearable, {}, PerformerIndex::of(p)});
  }
  return out;
}

constexpr BusKind kSimulatedKinds[] = {BusKind::can, BusKind::modbus_rtu, BusKind::serial};

Bus simulated_bus(BusKind kind, int round) {
  Bus out;
  const std::string name = kind == BusKind::can ? "can" : kind == BusKind::modbus_rtu ? "rtu" : "serial";
  out.name = name + "-" + std::to_string(round + 1);
  out.kind = kind;
  out.url = "sim://" + name;
  out.bits_per_second = kind == BusKind::can ? 500'000 : 115'200;
  return out;
}

}  // namespace

int nodes_that_carry_well(BusKind kind) {
  if (kind == BusKind::can) return 126;
  return kind == BusKind::serial ? 28 : 16;  // Modbus answers take their time
}

int last_address(BusKind kind) {
  switch (kind) {
    case BusKind::can:
      return 126;  // 127 is the controller
    case BusKind::serial:
      return 254;
    case BusKind::modbus_rtu:
    case BusKind::modbus_tcp:
      return 247;
    case BusKind::dmx:
      return 512;  // slots
  }
  return 247;
}

std::vector<Node> lay_nodes(const std::vector<Channel>& lamps, const std::vector<Bus>& all_buses,
                            const std::vector<BusIndex>& buses, const std::vector<int>& capacities,
                            const std::vector<std::vector<int>>& taken, int channels_per_node) {
  const auto step = static_cast<std::size_t>(channels_per_node);
  const auto share = shares(static_cast<int>((lamps.size() + step - 1) / step), capacities);
  std::vector<Node> out;
  std::size_t next_lamp = 0;
  for (std::size_t b = 0; b < buses.size(); ++b) {
    int address = 0;
    for (int n = 0; n < share[b]; ++n) {
      do ++address;
      while (std::find(taken[b].begin(), taken[b].end(), address) != taken[b].end());
      Node node;
      node.bus = buses[b];
      node.address = address;
      node.name = all_buses[buses[b].at()].name + "-" + std::to_string(address);
      const std::size_t end = std::min(next_lamp + step, lamps.size());
      node.channels.assign(lamps.begin() + static_cast<std::ptrdiff_t>(next_lamp),
                           lamps.begin() + static_cast<std::ptrdiff_t>(end));
      next_lamp = end;
      out.push_back(std::move(node));
    }
  }
  FL_CHECK(next_lamp == lamps.size());
  return out;
}

Rig make_simulated_rig(const Show& show) {
  const auto lamps = all_lamps(show);
  const int kinds = static_cast<int>(std::size(kSimulatedKinds));
  // A small floor is dealt in smaller portions, so that all three languages have something to say.
  const int channels = std::clamp(static_cast<int>(lamps.size() + kinds - 1) / kinds, 1, kChannelsPerNode);
  const int nodes = (static_cast<int>(lamps.size()) + channels - 1) / channels;
  Rig rig;
  std::vector<int> capacities;
  int capacity = 0;
  for (int round = 0; round == 0 || capacity < nodes; ++round) {
    for (const BusKind kind : kSimulatedKinds) {
      rig.buses.push_back(simulated_bus(kind, round));
      capacities.push_back(nodes_that_carry_well(kind));
      capacity += capacities.back();
    }
  }
  for (Bus& bus : rig.buses) {
    if (bus.kind == BusKind::modbus_rtu) bus.profile = footlight_marker_profile();
  }
  std::vector<BusIndex> buses;
  for (std::size_t b = 0; b < rig.buses.size(); ++b) buses.push_back(BusIndex::of(b));
  rig.nodes = lay_nodes(lamps, rig.buses, buses, capacities, std::vector<std::vector<int>>(buses.size()), channels);
  return rig;
}

}  // namespace footlight::config
