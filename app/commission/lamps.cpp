// SPDX-License-Identifier: Apache-2.0
#include "app/commission/lamps.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "core/check.hpp"
#include "core/sha256.hpp"

namespace footlight::app {

std::vector<FloorLamp> lamps_of(const Rig& rig) {
  std::vector<FloorLamp> out;
  for (std::size_t n = 0; n < rig.nodes.size(); ++n) {
    const auto& channels = rig.nodes[n].channels;
    for (std::size_t c = 0; c < channels.size(); ++c) {
      if (channels[c].kind == Channel::Kind::wearable) continue;
      FloorLamp lamp{{NodeIndex::of(n), static_cast<int>(c)}, {}};
      if (channels[c].kind == Channel::Kind::cell) lamp.cell = channels[c].cell;
      out.push_back(lamp);
    }
  }
  return out;
}

std::string lamp_name(const Rig& rig, MarkerPlace place) {
  return rig.nodes[place.node.at()].name + "/" + std::to_string(place.channel);
}

std::vector<std::size_t> walking_order(const std::vector<FloorLamp>& lamps, const Grid& grid, WalkOrder order) {
  std::vector<std::size_t> out(lamps.size());
  std::iota(out.begin(), out.end(), std::size_t{0});
  if (order == WalkOrder::bus) return out;
  const auto key = [&](std::size_t i) {
    if (!lamps[i].cell) return std::tuple(1, 0, 0);
    const Cell cell = grid.cell(*lamps[i].cell);
    return std::tuple(0, cell.row, cell.row % 2 == 0 ? cell.column : -cell.column);
  };
  std::ranges::stable_sort(out, {}, key);
  return out;
}

Rig with_places(Rig rig, const std::vector<FloorLamp>& lamps, const std::vector<std::optional<CellIndex>>& seen) {
  FL_CHECK(seen.size() == lamps.size());
  std::vector<CellIndex> taken;
  for (const auto& cell : seen) {
    if (cell) taken.push_back(*cell);
  }
  std::ranges::sort(taken);
  FL_CHECK(std::ranges::adjacent_find(taken) == taken.end());
  for (std::size_t i = 0; i < lamps.size(); ++i) {
    std::optional<CellIndex> cell = seen[i] ? seen[i] : lamps[i].cell;
    if (!seen[i] && cell && std::ranges::binary_search(taken, *cell)) cell.reset();
    Channel& channel = rig.nodes[lamps[i].place.node.at()].channels[static_cast<std::size_t>(lamps[i].place.channel)];
    channel = cell ? Channel{Channel::Kind::cell, *cell, {}} : Channel{};
  }
  return rig;
}

std::uint8_t crc8_bits(std::uint32_t value, int bits, std::uint8_t start) {
  constexpr unsigned kPolynomial = 0x2F;
  unsigned crc = start;
  for (int bit = bits - 1; bit >= 0; --bit) {
    const unsigned top = ((crc >> 7U) ^ (value >> static_cast<unsigned>(bit))) & 1U;
    crc = (crc << 1U) & 0xFFU;
    if (top != 0) crc ^= kPolynomial;
  }
  return static_cast<std::uint8_t>(crc);
}

std::uint8_t wiring_tag(const Rig& rig) {
  std::uint8_t crc = 0;
  for (const Node& node : rig.nodes) {
    for (const char c : rig.buses[node.bus.at()].name) crc = crc8_bits(static_cast<unsigned char>(c), 8, crc);
    crc = crc8_bits(static_cast<std::uint32_t>(node.address), 16, crc);
    for (const Channel& channel : node.channels) {
      crc = crc8_bits(channel.kind == Channel::Kind::wearable ? 1 : 0, 1, crc);
    }
  }
  return crc;
}

std::string places_digest(const Rig& rig) {
  Sha256 sum;
  for (const Node& node : rig.nodes) {
    sum.text(rig.buses[node.bus.at()].name);
    sum.integer(node.address);
    sum.integer(static_cast<std::int64_t>(node.channels.size()));
    for (const Channel& channel : node.channels) {
      sum.integer(channel.kind == Channel::Kind::cell ? static_cast<std::int64_t>(channel.cell.value()) : -1);
    }
  }
  return sum.hex();
}

}  // namespace footlight::app
