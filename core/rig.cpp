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
    case BusKind::dmx:
      return "dmx";
  }
  return "serial";
}

std::string_view to_text(Characters characters) {
  switch (characters) {
    case Characters::n1:
      return "8N1";
    case Characters::n2:
      return "8N2";
    case Characters::e1:
      return "8E1";
    case Characters::o1:
      return "8O1";
  }
  return "8N1";
}

}  // namespace footlight
