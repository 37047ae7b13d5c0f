// SPDX-License-Identifier: Apache-2.0
#include "drivers/transports/serial_device.hpp"
#include "drivers/transports/serial_ports.hpp"

namespace footlight::drivers {
namespace {

constexpr const char* kMissing =
    "this program was built without libserialport (install libserialport-dev and build again)";

}  // namespace

Result<std::vector<SerialPort>> list_serial_ports() { return device_error(std::string("serial ports: ") + kMissing); }

Result<std::unique_ptr<SerialDevice>> open_serial_port_device(const std::string& path,
                                                              const SerialSettings& /*settings*/) {
  return device_error("serial port \"" + path + "\": " + kMissing);
}

}  // namespace footlight::drivers
