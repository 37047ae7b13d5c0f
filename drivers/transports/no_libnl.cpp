// SPDX-License-Identifier: Apache-2.0
#include "drivers/transports/can_interface.hpp"

namespace footlight::drivers {

Result<CanInterface> read_can_interface(const std::string& name) {
  return refusal("CAN interface \"" + name +
                 "\": its settings are not known: this program was built without libnl-route (install "
                 "libnl-route-3-dev and build again)");
}

}  // namespace footlight::drivers
