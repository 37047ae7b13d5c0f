// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/device_bus.hpp"
#include "app/machine_wires.hpp"
#include "controller/bus_service.hpp"

namespace footlight::app {

/// Buses of a rig with their nodes and what is assumed of them, and what this machine has to put them on.
/// @param rig may be empty  @param assumptions one for each bus
[[nodiscard]] std::string list_text(const Rig& rig, const std::vector<std::string>& assumptions,
                                    const MachineWires& wires);
[[nodiscard]] std::string list_json(const Rig& rig, const std::vector<std::string>& assumptions,
                                    const MachineWires& wires);

/// What a scan has found, by address.
[[nodiscard]] std::string scan_text(const DeviceBus& bus, const std::vector<controller::FoundNode>& found);
[[nodiscard]] std::string scan_json(const DeviceBus& bus, const std::vector<controller::FoundNode>& found);

/// What one node keeps of plan and patch.
struct NodePatch {
  std::uint16_t address = 0;
  std::optional<drivers::KeptChecks> kept{};  ///< none: it does not tell
  std::optional<std::uint32_t> wanted{};      ///< patch_check of the rig; none: the rig has no such node
  [[nodiscard]] bool same() const { return kept && wanted && kept->patch == *wanted; }
};
[[nodiscard]] std::string patch_text(const DeviceBus& bus, const std::vector<NodePatch>& patches);
[[nodiscard]] std::string patch_json(const DeviceBus& bus, const std::vector<NodePatch>& patches);

/// How nodes are: last seen, errors, latency, what they tell of themselves.
[[nodiscard]] std::string health_text(const DeviceBus& bus, const std::vector<controller::NodeHealth>& health);
[[nodiscard]] std::string health_json(const DeviceBus& bus, const std::vector<controller::NodeHealth>& health,
                                      const std::string& verdict);

}  // namespace footlight::app
