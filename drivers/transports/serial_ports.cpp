// SPDX-License-Identifier: Apache-2.0
#include "drivers/transports/serial_ports.hpp"

#include <filesystem>
#include <system_error>

namespace footlight::drivers {

Result<std::string> find_usb_port(const std::vector<SerialPort>& ports, std::string_view serial_number) {
  std::vector<const SerialPort*> found;
  std::string others;
  for (const SerialPort& port : ports) {
    if (!port.usb || port.usb->serial_number.empty()) continue;
    if (port.usb->serial_number == serial_number) found.push_back(&port);
    others += (others.empty() ? "" : ", ") + port.usb->serial_number;
  }
  if (found.size() == 1) return found.front()->path;
  const std::string what = "serial port of the USB serial number \"" + std::string(serial_number) + "\": ";
  if (found.empty()) {
    return device_error(what + "not plugged in (" + (others.empty() ? "no port has one" : "there is " + others) + ")");
  }
  std::string places;
  for (const SerialPort* port : found) {
    places += (places.empty() ? "" : ", ") + (port->stable_path.empty() ? port->path : port->stable_path);
  }
  return device_error(what + std::to_string(found.size()) + " ports have it (one of " + places + ")");
}

std::string stable_path_of(const std::string& path, const std::string& folder) {
  std::error_code none;  // a folder that is not there has no links
  std::string first;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
    std::error_code broken;
    if (!std::filesystem::equivalent(entry.path(), path, broken) || broken) continue;
    if (first.empty() || entry.path().string() < first) first = entry.path().string();
  }
  return first;
}

}  // namespace footlight::drivers
