// SPDX-License-Identifier: Apache-2.0
#include "sim/markers/nmt_state.hpp"

namespace footlight::sim {

NmtReset take_nmt(const drivers::CanFrame& frame, std::uint8_t id, NmtState& state) {
  if (frame.length != 2 || (frame.data[1] != 0 && frame.data[1] != id)) return NmtReset::none;
  switch (frame.data[0]) {
    case 0x01:
      state = NmtState::operational;
      return NmtReset::none;
    case 0x02:
      state = NmtState::stopped;
      return NmtReset::none;
    case 0x80:
      state = NmtState::pre_operational;
      return NmtReset::none;
    case 0x81:
      state = NmtState::pre_operational;
      return NmtReset::node;
    case 0x82:
      state = NmtState::pre_operational;
      return NmtReset::communication;
    default:
      return NmtReset::none;
  }
}

}  // namespace footlight::sim
