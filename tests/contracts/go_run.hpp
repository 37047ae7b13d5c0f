// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/rig.hpp"
#include "core/time.hpp"

namespace footlight::contracts {

/// One simulated bus of a floor whose nodes have 32 channels each.
struct FloorBus {
  BusKind kind = BusKind::can;
  int bits_per_second = 500'000;
  int nodes = 1;
};

/// A GO that changes every lamp of a floor, on simulated buses in virtual time: when each node changed.
struct GoRun {
  Duration notice{};           ///< that the slowest bus asks for: the switch is so long after GO
  Duration within_bus{};       ///< between the first and the last node of a bus, of the worst bus
  Duration across_buses{};     ///< between the first and the last node of the floor
  Duration go_to_last_lamp{};  ///< from GO
  Duration preload{};          ///< from the first byte of the opening, look table and roll call among it, until every
                               ///< node has confirmed it
  Duration cpu{};              ///< of this machine's processor for loops and drivers in that time, of all buses
  int lit = 0;                 ///< nodes that changed
};

[[nodiscard]] GoRun go_on(const std::vector<FloorBus>& buses);

}  // namespace footlight::contracts
