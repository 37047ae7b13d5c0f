// SPDX-License-Identifier: Apache-2.0
#include "drivers/transports/serial_device.hpp"

#include <cerrno>
#include <string_view>
#include <system_error>
#include <utility>

#include <sys/stat.h>
#include <sys/sysmacros.h>

#include "drivers/transports/serial_ports.hpp"
#include "drivers/transports/transceiver.hpp"

namespace footlight::drivers {
namespace {

constexpr std::string_view kByUsbNumber = "usb/";
constexpr const char* kHint = " (a port as listed in /dev/serial/by-id)";

/// Unix98 slaves have the majors 136 to 143 (Linux, Documentation/admin-guide/devices.txt).
bool is_pseudo_terminal(const struct stat& status) {
  return major(status.st_rdev) >= 136 && major(status.st_rdev) <= 143;
}

Result<std::string> path_of(const std::string& place) {
  if (!place.starts_with(kByUsbNumber)) return place;
  const auto ports = list_serial_ports();
  if (!ports) return ports.error();
  return find_usb_port(*ports, place.substr(kByUsbNumber.size()));
}

Result<std::unique_ptr<SerialDevice>> open_by_kind(const std::string& path, const SerialSettings& settings) {
  const std::string what = "serial port \"" + path + "\": ";
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) {
    return device_error(what + std::generic_category().message(errno) + kHint);
  }
  if (!S_ISCHR(status.st_mode)) return device_error(what + "not a serial port" + kHint);
  return is_pseudo_terminal(status) ? open_terminal_device(path) : open_serial_port_device(path, settings);
}

}  // namespace

Duration SerialSettings::time_of(std::size_t count) const {
  const auto bits = static_cast<Duration::rep>(count) * bits_per_character();
  return Duration((bits * 1'000'000'000 + bits_per_second - 1) / bits_per_second);
}

Result<std::unique_ptr<SerialDevice>> open_serial_device(const std::string& place, const SerialSettings& settings) {
  const auto path = path_of(place);
  if (!path) return path.error();
  auto device = open_by_kind(*path, settings);
  if (!device) return device;
  auto transceiver = make_transceiver((*device)->poll_handle(), settings.line);
  if (!transceiver) return device_error("serial port \"" + *path + "\": " + transceiver.error().message);
  if (!*transceiver) return device;
  return std::unique_ptr<SerialDevice>(
      std::make_unique<TurnedDevice>(std::move(device).value(), std::move(transceiver).value(), settings));
}

}  // namespace footlight::drivers
