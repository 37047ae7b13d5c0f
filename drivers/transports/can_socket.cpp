// SPDX-License-Identifier: Apache-2.0
#include "drivers/transports/can_socket.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include "core/check.hpp"

namespace footlight::drivers {
namespace {

Error failed(const std::string& interface, const std::string& what, int error) {
  std::string hint = "ip link set " + interface + " up type can bitrate 500000 restart-ms 100";
  if (error == EAFNOSUPPORT) hint = "a kernel with CAN: modprobe can can_raw";
  return device_error("CAN interface \"" + interface + "\": " + what + ": " + std::generic_category().message(error) +
                      " (" + hint + ")");
}

}  // namespace

CanSocket::CanSocket(FileDescriptor socket, int bits_per_second)
    : socket_(std::move(socket)), bits_per_second_(bits_per_second) {
  FL_CHECK(bits_per_second_ > 0);
}

SendStatus CanSocket::send(const CanFrame& frame) {
  FL_CHECK(frame.kind == CanFrame::Kind::classic && frame.length <= 8);
  if (bus_off_) return SendStatus::down;
  struct can_frame raw {};
  raw.can_id = frame.id & CAN_SFF_MASK;
  raw.can_dlc = frame.length;
  std::copy_n(frame.data.begin(), frame.length, raw.data);
  if (::write(socket_.get(), &raw, sizeof raw) == static_cast<ssize_t>(sizeof raw)) {
    sent_by_ = std::max(sent_by_, clock_.now()) + wire_time(frame);
    return SendStatus::accepted;
  }
  // ENOBUFS: the queue is full, mostly because nobody acknowledges. The loop tries again; it must not spin here.
  const bool full = errno == ENOBUFS || errno == EAGAIN || errno == EINTR;
  return full ? SendStatus::busy : SendStatus::down;
}

bool CanSocket::receive(CanFrame& frame) {
  struct can_frame raw {};
  frame = {};
  while (::read(socket_.get(), &raw, sizeof raw) == static_cast<ssize_t>(sizeof raw)) {
    if ((raw.can_id & CAN_ERR_FLAG) != 0) {
      if ((raw.can_id & CAN_ERR_BUSOFF) != 0) bus_off_ = true;
      if ((raw.can_id & CAN_ERR_RESTARTED) != 0) bus_off_ = false;
      continue;
    }
    bus_off_ = false;  // what we hear proves that we are on the bus
    if ((raw.can_id & (CAN_EFF_FLAG | CAN_RTR_FLAG)) != 0 || raw.can_dlc > 8) continue;
    frame.id = static_cast<std::uint16_t>(raw.can_id & CAN_SFF_MASK);
    frame.length = raw.can_dlc;
    std::copy_n(raw.data, frame.length, frame.data.begin());
    return true;
  }
  return false;
}

Duration CanSocket::wire_time(const CanFrame& frame) const {
  const auto bits = static_cast<Duration::rep>(worst_can_bits(frame.length));
  return Duration((bits * 1'000'000'000 + bits_per_second_ - 1) / bits_per_second_);
}

std::size_t CanSocket::queued() const {
  const Duration left = sent_by_ - clock_.now();
  if (left <= Duration{}) return 0;
  const Duration frame = wire_time(CanFrame{.id = 0, .length = 8, .data = {}});
  return static_cast<std::size_t>((left + frame - Duration(1)) / frame);
}

Result<std::unique_ptr<CanPort>> open_can(const std::string& interface, int bits_per_second) {
  FileDescriptor file(::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW));
  if (file.get() < 0) return failed(interface, "no socket", errno);
  if (interface.empty() || interface.size() >= IFNAMSIZ) return failed(interface, "not found", ENODEV);
  const unsigned index = ::if_nametoindex(interface.c_str());
  if (index == 0) return failed(interface, "not found", errno);
  const can_err_mask_t errors = CAN_ERR_BUSOFF | CAN_ERR_RESTARTED;  // off unless asked for
  if (::setsockopt(file.get(), SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof errors) != 0) {
    return failed(interface, "error frames refused", errno);
  }
  struct sockaddr_can address {};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(index);
  if (::bind(file.get(), reinterpret_cast<struct sockaddr*>(&address), sizeof address) != 0) {
    return failed(interface, "not bound", errno);
  }
  return std::unique_ptr<CanPort>(std::make_unique<CanSocket>(std::move(file), bits_per_second));
}

}  // namespace footlight::drivers
