// SPDX-License-Identifier: Apache-2.0
#include "drivers/transports/gpio_line.hpp"

namespace footlight::drivers {

Result<std::unique_ptr<GpioLine>> open_gpio(const std::string& chip, unsigned offset,
                                            const GpioSettings& /*settings*/) {
  return device_error("GPIO line " + std::to_string(offset) + " of \"" + chip +
                      "\": this program was built without libgpiod (install libgpiod-dev and build again)");
}

Result<GpioChip> read_gpio_chip(const std::string& path) {
  return device_error("GPIO chip \"" + path +
                      "\": this program was built without libgpiod (install libgpiod-dev and build again)");
}

}  // namespace footlight::drivers
