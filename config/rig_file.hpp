// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/mapping_reader.hpp"
#include "core/rig.hpp"
#include "core/show.hpp"

namespace footlight::config {

/// What stands for a channel without a lamp, or with one whose cell is not known.
inline constexpr std::string_view kUnusedChannel = "unused";

/// Reads a rig for a show whose stage is known. Errors and warnings go to `diagnostics`; profiles that were read are
/// added to `files`.
/// @param performers_known false: wearables are not checked, since the roster itself has errors
[[nodiscard]] Rig read_rig(const std::string& file, const Show& show, bool performers_known, Diagnostics& diagnostics,
                           std::vector<std::string>& files);

/// The kind that a bus's URL stands for, simulated or not; nothing when the URL is none of ours.
[[nodiscard]] std::optional<BusKind> kind_of_url(std::string_view url);
/// A real one, for messages: "can://can0".
[[nodiscard]] std::string example_url(BusKind kind);
/// The real and the simulated one, for messages.
[[nodiscard]] std::string urls_of(BusKind kind);
/// "serial:///dev/..., rtu:///dev/..., ...", for messages.
[[nodiscard]] std::string known_urls();

/// Simulated buses of three kinds, as many as carry well, with a lamp for every cell that is not blocked and every
/// wearable of the performers. O(cells)
[[nodiscard]] Rig make_simulated_rig(const Show& show);

/// The most nodes that a bus carries well: CAN 126, serial 28, Modbus 16: they switch within half a second, receipts
/// included.
[[nodiscard]] int nodes_that_carry_well(BusKind kind);
[[nodiscard]] int last_address(BusKind kind);
/// Nodes `first_address`.. on each of `buses` for all `lamps` in their order, each bus a share as its capacity is.
/// @param capacities nodes, for each of `buses`; their sum x channels_per_node is at least lamps.size()
/// @param taken addresses in use, for each of `buses`
[[nodiscard]] std::vector<Node> lay_nodes(const std::vector<Channel>& lamps, const std::vector<Bus>& all_buses,
                                          const std::vector<BusIndex>& buses, const std::vector<int>& capacities,
                                          const std::vector<std::vector<int>>& taken, int channels_per_node);

}  // namespace footlight::config
