// SPDX-License-Identifier: Apache-2.0
#include "drivers/transports/modbus_port.hpp"

namespace footlight::drivers {
namespace {

Error missing(const std::string& what) {
  return device_error(what + ": this program was built without libmodbus (install libmodbus-dev and build again)");
}

}  // namespace

Result<std::unique_ptr<ModbusPort>> open_modbus_rtu(const std::string& place, const SerialSettings& /*settings*/) {
  return missing("Modbus line \"" + place + "\"");
}

Result<std::unique_ptr<ModbusPort>> open_modbus_tcp(const std::string& host, int port,
                                                    // The signature is that of the real one.
                                                    // NOLINTNEXTLINE(performance-unnecessary-value-param)
                                                    std::vector<std::uint8_t> /*units*/) {
  return missing("Modbus device \"" + host + ":" + std::to_string(port) + "\"");
}

}  // namespace footlight::drivers
