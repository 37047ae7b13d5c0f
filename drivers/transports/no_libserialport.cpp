// SPDX-License-Identifier: Apache-2.0
#include "drivers/transports/serial_stream.hpp"

namespace footlight::drivers {

Result<std::unique_ptr<SerialDevice>> open_serial_port_device(const std::string& path, int /*bits_per_second*/) {
  return device_error("serial port \"" + path +
                      "\": this program was built without libserialport (install libserialport-dev and build again)");
}

}  // namespace footlight::drivers
