// SPDX-License-Identifier: Apache-2.0
#include "app/remote/osc_packet.hpp"

namespace footlight::app {

Result<std::vector<OscMessage>> read_osc(std::span<const std::byte> /*datagram*/) {
  return device_error("OSC: this program was built without liblo (install liblo-dev and build again)");
}

std::vector<std::byte> osc_bytes(const OscMessage& /*message*/) { return {}; }
std::vector<std::byte> osc_bundle(const std::vector<OscMessage>& /*messages*/) { return {}; }

}  // namespace footlight::app
