// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "drivers/registry.hpp"

namespace footlight::drivers {

/// A controller among others that may be wired to the same nodes: nodes follow the newest epoch and refuse the frames
/// of older ones (docs/wire-protocol.md, section 1, lead). Shared by the buses of a run.
struct Leadership {
  std::uint32_t epoch = 0;                 ///< 0: it leads without one, and nobody is fenced
  std::atomic<std::uint64_t> refusals{0};  ///< by nodes that follow another controller, all buses
};

/// Heartbeats from one LEAD to the next: a second, and a fence stands for 2.5 s.
inline constexpr unsigned kBeatsALead = 4;

/// The plan byte of a controller that leads under an epoch: never 0, and another one for the epoch after it.
[[nodiscard]] std::uint8_t leading_byte(std::uint8_t plan_byte, std::uint32_t epoch);

/// Whether nodes of this bus can fence: our own markers, whatever language they speak. DMX lamps, modules of outputs
/// and foreign Modbus devices refuse nobody.
[[nodiscard]] bool can_fence(const Bus& bus);
/// Names of the buses on which nobody refuses another controller.
[[nodiscard]] std::vector<std::string> unfenced(const std::vector<Bus>& buses);

/// As `make_driver`, for a controller that leads. @param leadership borrowed for the life of the driver
[[nodiscard]] Result<std::unique_ptr<Driver>> make_leading_driver(const Bus& bus, const std::vector<NodeAddress>& nodes,
                                                                  std::uint8_t plan_byte, PortReference port,
                                                                  Leadership& leadership);

}  // namespace footlight::drivers
