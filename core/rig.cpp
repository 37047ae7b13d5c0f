// SPDX-License-Identifier: Apache-2.0
#include "core/rig.hpp"

#include <string_view>

namespace footlight {

std::string_view to_text(BusKind kind) {
  switch (kind) {
    case BusKind::serial:
      return "serial";
    case BusKind::modbus_rtu:
      return "modbus-rtu";
    case BusKind::modbus_tcp:
      return "modbus-tcp";
    case BusKind::can:
      return "can";
  }
  return "serial";
}

}  // namespace footlight
