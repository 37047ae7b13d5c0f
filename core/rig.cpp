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

ModbusProfile footlight_marker_profile() {
  ModbusProfile out;
  out.name = "footlight-marker";
  out.look_register = 0x0000;
  out.latch_register = 0x0020;
  out.heartbeat_register = 0x0030;
  out.status_register = 0x0040;
  out.look_table_register = 0x0050;
  out.unique_id_register = 0x0060;
  out.identity_register = 0x0062;
  out.identity_registers = 8;
  out.identity_is_text = true;
  out.identify_register = 0x006A;
  out.readdress_register = 0x006C;
  out.health = {{"battery", 0x0048, 1, "%", false},
                {"supply", 0x0049, 0.001, "V", false},
                {"temperature", 0x004A, 0.1, "C", true}};
  return out;
}

}  // namespace footlight
