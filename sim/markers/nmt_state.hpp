// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "drivers/transport.hpp"

namespace footlight::sim {

/// What a CANopen node takes part in (CiA 301, 7.3.2.2); the values are those of its heartbeat.
enum class NmtState : std::uint8_t { stopped = 4, operational = 5, pre_operational = 127 };

/// What of a node starts anew. It is pre-operational then, and says so by its boot-up.
enum class NmtReset { none, communication, node };

/// Changes the state by a command of network management.
/// @param frame of identifier 0; one of another length or for another node changes nothing
[[nodiscard]] NmtReset take_nmt(const drivers::CanFrame& frame, std::uint8_t id, NmtState& state);

}  // namespace footlight::sim
