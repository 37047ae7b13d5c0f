// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/grid.hpp"
#include "core/rig.hpp"

namespace footlight::app {

/// A lamp on the floor, as the rig has it. Wearables are none.
struct FloorLamp {
  MarkerPlace place;
  std::optional<CellIndex> cell;  ///< where the rig says that it is; nothing: it was never assigned
};

/// Every channel that is a cell's or nobody's, in the order of the rig: node by node, channel by channel. What a film
/// or a walk says of lamp i is said of the i-th of them.
[[nodiscard]] std::vector<FloorLamp> lamps_of(const Rig& rig);

/// "can-1-7/3": node and channel, channels from 0 as in the rig file.
[[nodiscard]] std::string lamp_name(const Rig& rig, MarkerPlace place);

enum class WalkOrder {
  floor,  ///< row by row from downstage, there and back again: nobody walks an empty row
  bus,    ///< as the cables go: the order of the rig
};

/// Positions in `lamps` in the order in which somebody walks from one to the next; lamps that were never assigned come
/// last, in the order of the rig. A permutation.
[[nodiscard]] std::vector<std::size_t> walking_order(const std::vector<FloorLamp>& lamps, const Grid& grid,
                                                     WalkOrder order);

/// The rig with every lamp where it was seen. A lamp that was not seen keeps the cell of the rig unless another was
/// seen there; then its channel is unused. No two lamps of `seen` are on one cell (a programmer error).
/// @param seen for each of `lamps`
[[nodiscard]] Rig with_places(Rig rig, const std::vector<FloorLamp>& lamps,
                              const std::vector<std::optional<CellIndex>>& seen);

/// Which channels there are, whatever cells they have: the same for two rigs of which a film of one can be read for the
/// other.
[[nodiscard]] std::uint8_t wiring_tag(const Rig& rig);
/// Hex SHA-256 over which lamp is on which cell, by bus, address and channel; URLs, names of
/// nodes and wearables do not count.
[[nodiscard]] std::string places_digest(const Rig& rig);

/// CRC-8 with the polynomial 0x2F (x^8 + x^5 + x^3 + x^2 + x + 1), most significant bit first, start 0, no reflection,
/// no final xor. Two different texts of at most 119 bits with their CRC differ in at least 4 bits (P. Koopman's tables,
/// "0x97").
[[nodiscard]] std::uint8_t crc8_bits(std::uint32_t value, int bits, std::uint8_t start = 0);

}  // namespace footlight::app
