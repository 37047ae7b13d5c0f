// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include <linux/can/netlink.h>
#include <net/if.h>
#include <netlink/netlink.h>
#include <netlink/route/link.h>
#include <netlink/route/link/can.h>

#include "drivers/transports/can_interface.hpp"

// The kernel's flag IFF_ECHO; <linux/if.h>, which has it, cannot stand beside <net/if.h>.
#ifndef IFF_ECHO
#define IFF_ECHO (1U << 18U)
#endif

namespace footlight::drivers {
namespace {

constexpr std::uint32_t kUnknownRate = 0xFFFF'FFFF;  // the kernel's CAN_BITRATE_UNKNOWN, which no header gives us

using Socket = std::unique_ptr<nl_sock, decltype(&nl_socket_free)>;
using Link = std::unique_ptr<rtnl_link, decltype(&rtnl_link_put)>;

Error failed(const std::string& name, const std::string& what, const std::string& hint) {
  return device_error("CAN interface \"" + name + "\": " + what + " (" + hint + ")");
}

CanState state_of(std::uint32_t kernels) {
  switch (kernels) {
    case CAN_STATE_ERROR_WARNING:
      return CanState::warning;
    case CAN_STATE_ERROR_PASSIVE:
      return CanState::passive;
    case CAN_STATE_BUS_OFF:
      return CanState::bus_off;
    default:
      return CanState::active;  // STOPPED says nothing: some drivers say so while they work
  }
}

CanInterface::Controller read_controller(rtnl_link* link) {
  CanInterface::Controller controller;
  std::uint32_t value = 0;
  if (rtnl_link_can_get_bitrate(link, &value) == 0 && value != kUnknownRate) {
    controller.bits_per_second = static_cast<int>(value);
  }
  if (rtnl_link_can_get_restart_ms(link, &value) == 0) controller.restart_ms = static_cast<int>(value);
  if (rtnl_link_can_state(link, &value) == 0) controller.state = state_of(value);
  struct can_berr_counter counters {};
  if (rtnl_link_can_berr(link, &counters) == 0) {
    controller.transmit_errors = counters.txerr;
    controller.receive_errors = counters.rxerr;
  }
  controller.echoes = (rtnl_link_get_flags(link) & IFF_ECHO) != 0;
  return controller;
}

}  // namespace

Result<CanInterface> read_can_interface(const std::string& name) {
  const Socket socket(nl_socket_alloc(), &nl_socket_free);
  if (!socket) return failed(name, "no netlink socket", "free memory");
  if (const int error = nl_connect(socket.get(), NETLINK_ROUTE); error < 0) {
    return failed(name, std::string("netlink: ") + nl_geterror(error), "a kernel with netlink");
  }
  rtnl_link* found = nullptr;
  if (const int error = rtnl_link_get_kernel(socket.get(), 0, name.c_str(), &found); error < 0) {
    return failed(name, "not found",
                  "plug the adapter in and load its driver; `ip link show type can` lists what there is");
  }
  const Link link(found, &rtnl_link_put);
  const char* type = rtnl_link_get_type(link.get());
  const std::string kind = type == nullptr ? "" : type;
  if (kind != "can" && kind != "vcan" && kind != "vxcan") {
    return failed(name, "is not a CAN interface", "one that `ip link show type can` lists");
  }
  CanInterface interface;
  interface.name = name;
  interface.up = (rtnl_link_get_flags(link.get()) & IFF_UP) != 0;
  interface.queue_length = static_cast<int>(rtnl_link_get_txqlen(link.get()));
  if (kind == "can") interface.controller = read_controller(link.get());
  return interface;
}

}  // namespace footlight::drivers
