// SPDX-License-Identifier: Apache-2.0
#include "sim/endpoints/can_endpoint.hpp"

#include <algorithm>
#include <cerrno>
#include <system_error>

#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

namespace footlight::sim {
namespace {

constexpr std::size_t kMostWaiting = 4096;
constexpr Duration kAgain = milliseconds(1);

Error failed(const std::string& interface, const std::string& what) {
  const int error = errno;
  return device_error("CAN interface \"" + interface + "\": " + what + ": " + std::generic_category().message(error) +
                      " (ip link add dev " + interface + " type vcan && ip link set " + interface +
                      " up; --can BUS=INTERFACE)");
}

}  // namespace

Result<std::unique_ptr<CanEndpoint>> CanEndpoint::open(const std::string& interface, drivers::CanPort& bus) {
  FileDescriptor socket(::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW));
  if (socket.get() < 0) return failed(interface, "no socket");
  struct sockaddr_can address {};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(::if_nametoindex(interface.c_str()));
  if (address.can_ifindex == 0) return failed(interface, "not found");
  if (::bind(socket.get(), reinterpret_cast<struct sockaddr*>(&address), sizeof address) != 0) {
    return failed(interface, "not bound");
  }
  return std::make_unique<CanEndpoint>(std::move(socket), interface, bus);
}

void CanEndpoint::add_handles(std::vector<pollfd>& files) const { files.push_back({socket_.get(), POLLIN, 0}); }

void CanEndpoint::listen() {
  struct can_frame raw {};
  while (heard_.size() < kMostWaiting && ::read(socket_.get(), &raw, sizeof raw) == static_cast<ssize_t>(sizeof raw)) {
    if ((raw.can_id & (CAN_EFF_FLAG | CAN_RTR_FLAG | CAN_ERR_FLAG)) != 0 || raw.can_dlc > CAN_MAX_DLEN) continue;
    drivers::CanFrame frame;
    frame.id = static_cast<std::uint16_t>(raw.can_id & CAN_SFF_MASK);
    frame.length = raw.can_dlc;
    std::copy_n(raw.data, raw.can_dlc, frame.data.begin());
    heard_.push_back(frame);
    used_ = true;
  }
}

Instant CanEndpoint::step(Instant now) {
  listen();
  while (!heard_.empty() && bus_.send(heard_.front()) == drivers::SendStatus::accepted) heard_.pop_front();
  drivers::CanFrame frame;
  while (bus_.receive(frame)) {
    if (said_.size() < kMostWaiting) said_.push_back(frame);
  }
  while (!said_.empty()) {
    struct can_frame raw {};
    raw.can_id = said_.front().id;
    // A program may say error frames itself; on a virtual interface the others hear them as the kernel's.
    if (said_.front().kind == drivers::CanFrame::Kind::error) raw.can_id |= CAN_ERR_FLAG;
    raw.can_dlc = said_.front().length;
    std::copy_n(said_.front().data.begin(), raw.can_dlc, raw.data);
    // ENOBUFS: the interface's queue is full. A moment later it is not, or nobody is there who could listen.
    if (::write(socket_.get(), &raw, sizeof raw) != static_cast<ssize_t>(sizeof raw)) break;
    said_.pop_front();
  }
  return heard_.empty() && said_.empty() ? kNever : now + kAgain;
}

}  // namespace footlight::sim
