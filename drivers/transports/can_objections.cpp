// SPDX-License-Identifier: Apache-2.0
#include "drivers/transports/can_interface.hpp"

namespace footlight::drivers {
namespace {

constexpr int kLongestRestartMs = 200;  // bus-off, restart, full state again: within a second
constexpr int kShortestQueue = 10;      // frames that the CANopen driver may have waiting
constexpr int kRestartMs = 100;

}  // namespace

std::vector<Objection> objections(const CanInterface& interface, int bits_per_second) {
  std::vector<Objection> found;
  const std::string& name = interface.name;
  const std::string rate = std::to_string(bits_per_second);
  const auto object = [&](const std::string& what, const std::string& mends, bool stops = false) {
    found.push_back({"CAN interface \"" + name + "\": " + what + " (" + mends + ")", stops});
  };
  const std::string set =
      interface.controller ? " type can bitrate " + rate + " restart-ms " + std::to_string(kRestartMs) : std::string();
  const std::string anew = "ip link set " + name + " down; ip link set " + name + " up" + set;
  if (interface.queue_length < kShortestQueue) {
    object("its queue holds " + std::to_string(interface.queue_length) + " frames, less than a node's preload needs",
           "ip link set " + name + " txqueuelen " + std::to_string(kShortestQueue));
  }
  if (!interface.up) object("is down", "ip link set " + name + " up" + set, true);
  if (!interface.controller) return found;
  const CanInterface::Controller& controller = *interface.controller;
  if (controller.bits_per_second != 0 && controller.bits_per_second != bits_per_second) {
    object("runs at " + std::to_string(controller.bits_per_second) + " bit/s, and the rig says " + rate, anew, true);
  }
  if (controller.restart_ms == 0) {
    object("stays silent after bus-off", anew);
  } else if (controller.restart_ms > kLongestRestartMs) {
    object("waits " + std::to_string(controller.restart_ms) + " ms after bus-off", anew);
  }
  const std::string counters = std::to_string(controller.transmit_errors) + " transmit errors, " +
                               std::to_string(controller.receive_errors) + " receive errors";
  if (controller.state == CanState::bus_off) {
    const bool stays = controller.restart_ms == 0;
    object("is bus-off",
           stays ? "ip link set " + name + " type can restart"
                 : "both ends terminated by 120 Ohm, CAN-H and CAN-L not exchanged, every node at " + rate + " bit/s",
           stays);
  } else if (interface.up && controller.state != CanState::active) {
    object("counts " + counters, "both ends terminated by 120 Ohm, every node powered and at " + rate + " bit/s");
  }
  if (!controller.echoes) {
    object("its driver does not tell when a frame has left, so a dead wire is seen by silent nodes alone",
           "an adapter whose interface `ip link` shows with ECHO");
  }
  return found;
}

}  // namespace footlight::drivers
