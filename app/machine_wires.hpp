// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/rig.hpp"
#include "drivers/transports/can_interface.hpp"
#include "drivers/transports/gpio_line.hpp"
#include "drivers/transports/serial_ports.hpp"

namespace footlight::app {

/// What this machine has to put buses on.
struct MachineWires {
  std::vector<drivers::SerialPort> serial;  ///< no pseudo-terminals
  std::vector<drivers::CanInterface> can;
  std::vector<drivers::GpioChip> gpio;
  std::vector<std::string> troubles;  ///< what is there and cannot be read, in whole sentences
};

/// Looks at ports, interfaces and chips; opens nothing that could disturb a bus.
[[nodiscard]] MachineWires look_at_machine();

/// Names of the buses whose wire it is, by any of the names that the port or interface has; the direction line of a bus
/// counts for its chip.
[[nodiscard]] std::vector<std::string> buses_on(const drivers::SerialPort& port, const Rig& rig);
[[nodiscard]] std::vector<std::string> buses_on(const drivers::CanInterface& interface, const Rig& rig);
[[nodiscard]] std::vector<std::string> buses_on(const drivers::GpioChip& chip, const Rig& rig);

/// For people, and for programs. @param rig may be empty
[[nodiscard]] std::string wires_text(const MachineWires& wires, const Rig& rig);
[[nodiscard]] nlohmann::ordered_json wires_json(const MachineWires& wires, const Rig& rig);

}  // namespace footlight::app
