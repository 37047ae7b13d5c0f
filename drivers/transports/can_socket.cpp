// SPDX-License-Identifier: Apache-2.0
#include "drivers/transports/can_socket.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <system_error>
#include <utility>

#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/check.hpp"

namespace footlight::drivers {
namespace {

constexpr Duration kReopenPeriod = milliseconds(100);
constexpr Duration kTryWithoutRestart = milliseconds(1000);
// Echoes and the answers of 126 nodes come in one burst; the kernel doubles this and caps it at net.core.rmem_max.
constexpr int kReceiveBuffer = 1 << 20;
constexpr std::size_t kLongestClassic = 8;

Error failed(const std::string& interface, const std::string& what, int error) {
  std::string hint = "ip link set " + interface + " up type can bitrate 500000 restart-ms 100";
  if (error == EAFNOSUPPORT) hint = "a kernel with CAN: modprobe can can_raw";
  return device_error("CAN interface \"" + interface + "\": " + what + ": " + std::generic_category().message(error) +
                      " (" + hint + ")");
}

/// Absent: there is no interface of that name.
std::optional<CanState> state_of(int socket, const std::string& interface) {
  struct ifreq request {};
  interface.copy(request.ifr_name, IFNAMSIZ - 1);
  if (::ioctl(socket, SIOCGIFFLAGS, &request) != 0) return std::nullopt;
  // IFF_RUNNING would tell of bus-off, but lags behind for up to a second.
  return (request.ifr_flags & IFF_UP) != 0 ? CanState::active : CanState::down;
}

Status<> set_options(int socket, const std::string& interface) {
  const auto set = [&](int level, int option, const auto& value) {
    return ::setsockopt(socket, level, option, &value, sizeof value) == 0;
  };
  const can_err_mask_t errors = CAN_ERR_MASK;  // off unless asked for
  if (!set(SOL_CAN_RAW, CAN_RAW_ERR_FILTER, errors)) return failed(interface, "error frames refused", errno);
  const int on = 1;
  if (!set(SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, on)) return failed(interface, "echo refused", errno);
  if (!set(SOL_CAN_RAW, CAN_RAW_FD_FRAMES, on)) return failed(interface, "FD frames refused", errno);
  const struct can_filter eleven_bits { 0, CAN_EFF_FLAG | CAN_RTR_FLAG };
  if (!set(SOL_CAN_RAW, CAN_RAW_FILTER, eleven_bits)) return failed(interface, "filter refused", errno);
  // Without these two less fits, and what did not fit is not known.
  set(SOL_SOCKET, SO_RCVBUF, kReceiveBuffer);
  set(SOL_SOCKET, SO_RXQ_OVFL, on);
  return Done{};
}

Result<FileDescriptor> open_socket(const std::string& interface) {
  FileDescriptor file(::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW));
  if (file.get() < 0) return failed(interface, "no socket", errno);
  if (interface.empty() || interface.size() >= IFNAMSIZ) return failed(interface, "not found", ENODEV);
  const unsigned index = ::if_nametoindex(interface.c_str());
  if (index == 0) return failed(interface, "not found", errno);
  if (auto set = set_options(file.get(), interface); !set) return std::move(set).error();
  struct sockaddr_can address {};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(index);
  if (::bind(file.get(), reinterpret_cast<struct sockaddr*>(&address), sizeof address) != 0) {
    return failed(interface, "not bound", errno);
  }
  return file;
}

bool possible_length(const CanFrame& frame) {
  if (frame.length <= kLongestClassic) return true;
  constexpr std::array<std::uint8_t, 7> kLonger{12, 16, 20, 24, 32, 48, 64};
  return frame.kind != CanFrame::Kind::classic &&
         std::find(kLonger.begin(), kLonger.end(), frame.length) != kLonger.end();
}

/// The kernel's two frames have their fields at the same places.
struct canfd_frame to_kernel(const CanFrame& frame) {
  struct canfd_frame raw {};
  raw.can_id = frame.id;
  raw.len = frame.length;
  if (frame.kind == CanFrame::Kind::fd_fast) raw.flags = CANFD_BRS;
  std::copy_n(frame.data.begin(), frame.length, raw.data);
  return raw;
}

CanFrame from_kernel(const struct canfd_frame& raw, bool fd) {
  CanFrame frame;
  frame.id = static_cast<std::uint16_t>(raw.can_id & 0xFFFFU);
  frame.length = std::min<std::uint8_t>(raw.len, fd ? CANFD_MAX_DLEN : CAN_MAX_DLEN);
  std::copy_n(raw.data, frame.length, frame.data.begin());
  if ((raw.can_id & CAN_ERR_FLAG) != 0) {
    frame.kind = CanFrame::Kind::error;
  } else if (fd) {
    frame.kind = (raw.flags & CANFD_BRS) != 0 ? CanFrame::Kind::fd_fast : CanFrame::Kind::fd;
  }
  return frame;
}

/// How many frames the kernel had to drop since the socket was opened, if it says so.
std::optional<std::uint32_t> drops(struct msghdr& message) {
  for (auto* control = CMSG_FIRSTHDR(&message); control != nullptr; control = CMSG_NXTHDR(&message, control)) {
    if (control->cmsg_level != SOL_SOCKET || control->cmsg_type != SO_RXQ_OVFL) continue;
    std::uint32_t count = 0;
    std::memcpy(&count, CMSG_DATA(control), sizeof count);
    return count;
  }
  return std::nullopt;
}

}  // namespace

CanSocket::CanSocket(FileDescriptor socket, std::string interface, int bits_per_second, const Clock& clock,
                     CanState state)
    : socket_(std::move(socket)),
      interface_(std::move(interface)),
      bits_per_second_(bits_per_second),
      clock_(clock),
      in_flight_(can_stall_time(bits_per_second)),
      state_(state) {}

SendStatus CanSocket::send(const CanFrame& frame) {
  FL_CHECK(frame.kind != CanFrame::Kind::error && frame.id <= CAN_SFF_MASK && possible_length(frame));
  reopen_when_due();
  const bool hopeless = state_ == CanState::bus_off && clock_.now() < try_again_;
  if (state_ == CanState::down || hopeless) return SendStatus::down;
  const struct canfd_frame raw = to_kernel(frame);
  const std::size_t size = frame.kind == CanFrame::Kind::classic ? CAN_MTU : CANFD_MTU;
  if (::write(socket_.get(), &raw, size) == static_cast<ssize_t>(size)) {
    in_flight_.accepted(frame, clock_.now());
    return SendStatus::accepted;
  }
  // ENOBUFS: the queue is full, mostly because nobody acknowledges. The loop tries again; it must not spin here.
  if (errno == ENOBUFS || errno == EAGAIN || errno == EINTR) {
    in_flight_.refused(clock_.now());
    return SendStatus::busy;
  }
  go_down();
  return SendStatus::down;
}

bool CanSocket::receive(CanFrame& frame) {
  reopen_when_due();
  for (;;) {
    switch (read_one(frame)) {
      case Heard::frame:
        return true;
      case Heard::nothing:
        return false;
      case Heard::other:
        break;
    }
  }
}

CanSocket::Heard CanSocket::read_one(CanFrame& frame) {
  struct canfd_frame raw {};
  struct iovec part {
    &raw, sizeof raw
  };
  alignas(struct cmsghdr) std::array<char, CMSG_SPACE(sizeof(std::uint32_t))> control{};
  struct msghdr message {};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  const ssize_t size = ::recvmsg(socket_.get(), &message, 0);
  if (size < 0) {
    if (errno != EAGAIN && errno != EINTR) go_down();
    return Heard::nothing;
  }
  if (size == 0) return Heard::nothing;
  if (const auto count = drops(message); count && *count != dropped_) {
    dropped_ = *count;
    in_flight_.forget();  // echoes may have been among them
  }
  const bool fd = static_cast<std::size_t>(size) == CANFD_MTU;
  if (!fd && static_cast<std::size_t>(size) != CAN_MTU) return Heard::other;
  frame = from_kernel(raw, fd);
  if (frame.kind == CanFrame::Kind::error) {
    take_error_frame(frame);
    return Heard::frame;
  }
  if ((raw.can_id & (CAN_EFF_FLAG | CAN_RTR_FLAG)) != 0) return Heard::other;
  // What has been on the wire proves that we are on it.
  if (state_ == CanState::bus_off) state_ = CanState::active;
  if ((message.msg_flags & MSG_CONFIRM) == 0) return Heard::frame;
  in_flight_.echoed(frame, clock_.now());
  return Heard::other;
}

void CanSocket::take_error_frame(const CanFrame& frame) {
  if ((frame.id & CAN_ERR_BUSOFF) != 0) {
    go_off();
  } else if ((frame.id & CAN_ERR_RESTARTED) != 0) {
    in_flight_.forget();
    state_ = CanState::active;
  } else if ((frame.id & CAN_ERR_CRTL) != 0) {
    const unsigned status = frame.data[1];
    if ((status & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) != 0) {
      state_ = CanState::passive;
    } else if ((status & (CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING)) != 0) {
      state_ = CanState::warning;
    } else if ((status & CAN_ERR_CRTL_ACTIVE) != 0) {
      state_ = CanState::active;
    }
  }
}

void CanSocket::go_off() {
  in_flight_.forget();  // the kernel empties queue and controller
  state_ = CanState::bus_off;
  try_again_ = clock_.now() + kTryWithoutRestart;
}

void CanSocket::go_down() {
  in_flight_.forget();
  state_ = CanState::down;
  try_again_ = clock_.now() + kReopenPeriod;
}

/// An interface that was unplugged comes back as another one of the same name, hence by a new socket.
void CanSocket::reopen_when_due() {
  if (state_ != CanState::down || clock_.now() < try_again_) return;
  try_again_ = clock_.now() + kReopenPeriod;
  const auto state = state_of(socket_.get(), interface_);
  if (!state || *state == CanState::down) return;
  auto socket = open_socket(interface_);
  if (!socket) return;
  socket_ = std::move(socket).value();
  dropped_ = 0;
  state_ = *state;
}

CanState CanSocket::state() const {
  return state_ < CanState::stalled && in_flight_.stalled(clock_.now()) ? CanState::stalled : state_;
}

Duration CanSocket::wire_time(const CanFrame& frame) const {
  const auto bits = static_cast<Duration::rep>(worst_can_bits(frame.length));
  return Duration((bits * 1'000'000'000 + bits_per_second_ - 1) / bits_per_second_);
}

std::string CanSocket::trouble() const {
  if (state() < CanState::stalled) return {};
  const std::string interface = "CAN interface \"" + interface_ + "\": ";
  switch (state()) {
    case CanState::bus_off:
      return interface + "bus-off: silent until it is restarted (wiring and bit rate; restart-ms 100 restarts it)";
    case CanState::down:
      return interface + "taken down, or its adapter is unplugged";
    case CanState::stalled:
      return interface + "frames wait and none leaves: nobody acknowledges (cable, terminators, power of the markers)";
    case CanState::active:
    case CanState::warning:
    case CanState::passive:
      return {};
  }
  return {};
}

Result<std::unique_ptr<CanPort>> open_can(const std::string& interface, int bits_per_second) {
  static const SteadyClock clock;
  auto socket = open_socket(interface);
  if (!socket) return std::move(socket).error();
  const CanState state = state_of(socket->get(), interface).value_or(CanState::down);
  return std::unique_ptr<CanPort>(
      std::make_unique<CanSocket>(std::move(socket).value(), interface, bits_per_second, clock, state));
}

}  // namespace footlight::drivers
