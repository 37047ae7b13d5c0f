// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"

namespace footlight::drivers {

/// A serial port of this machine; what is not known is empty.
struct SerialPort {
  struct Usb {
    std::uint16_t vendor = 0;
    std::uint16_t product = 0;
    std::string manufacturer;
    std::string name;
    std::string serial_number;
  };
  std::string path;         ///< "/dev/ttyUSB0"; may be another one after the next plugging in
  std::string stable_path;  ///< "/dev/serial/by-id/...", which stays; the place to write into a rig
  std::string description;
  std::optional<Usb> usb;
};

/// Every serial port that libserialport knows, in the order of their names; pseudo-terminals are not among them.
/// Errors: ErrorKind::device: what the machine said, or a program built without that library.
[[nodiscard]] Result<std::vector<SerialPort>> list_serial_ports();

/// Path of the port whose adapter has this USB serial number.
/// Errors: ErrorKind::device when there is none or more than one, with those that there are.
[[nodiscard]] Result<std::string> find_usb_port(const std::vector<SerialPort>& ports, std::string_view serial_number);

/// The link in `folder` (/dev/serial/by-id) that leads to `path`, the first by name; empty when none does.
[[nodiscard]] std::string stable_path_of(const std::string& path, const std::string& folder);

}  // namespace footlight::drivers
