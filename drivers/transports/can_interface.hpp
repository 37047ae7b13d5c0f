// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "drivers/objection.hpp"
#include "drivers/transport.hpp"

namespace footlight::drivers {

/// How the kernel has a CAN interface set up.
struct CanInterface {
  /// Of a real controller; virtual interfaces have none.
  struct Controller {
    int bits_per_second = 0;  ///< 0: not set, or the adapter's own affair
    int restart_ms = 0;       ///< after bus-off; 0: stays off
    CanState state = CanState::active;
    int transmit_errors = 0;  ///< the two error counters
    int receive_errors = 0;
    bool echoes = true;  ///< its driver tells when a frame has been on the wire
  };
  std::string name;
  bool up = false;
  int queue_length = 0;  ///< txqueuelen, frames
  std::optional<Controller> controller;
};

/// Asks the kernel by netlink (libnl-route).
/// Errors: ErrorKind::device: no such interface, or not a CAN interface; ErrorKind::refused: a program built without
/// libnl, which cannot know.
[[nodiscard]] Result<CanInterface> read_can_interface(const std::string& name);

/// CAN interfaces of this machine, virtual ones too, in the order of their names; it needs no library.
/// @param folder in which the kernel has a folder for each network interface
[[nodiscard]] std::vector<std::string> can_interface_names(const std::string& folder = "/sys/class/net");

/// What would go wrong with it in a show, with the command that mends it. Empty: nothing.
/// @param bits_per_second as the rig says
[[nodiscard]] std::vector<Objection> objections(const CanInterface& interface, int bits_per_second);

}  // namespace footlight::drivers
