// SPDX-License-Identifier: Apache-2.0
#include "app/console/peer_owner.hpp"

#include <array>
#include <cstring>

#include <linux/inet_diag.h>
#include <linux/netlink.h>
#include <linux/sock_diag.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>

#include "core/file_descriptor.hpp"

namespace footlight::app {
namespace {

struct Request {
  nlmsghdr header{};
  inet_diag_req_v2 ask{};
};

/// The addresses as the other end has them: its own is our peer's.
bool fill(int socket, inet_diag_req_v2& ask) {
  sockaddr_storage ours{};
  sockaddr_storage theirs{};
  socklen_t size = sizeof ours;
  if (::getsockname(socket, reinterpret_cast<sockaddr*>(&ours), &size) != 0) return false;
  size = sizeof theirs;
  if (::getpeername(socket, reinterpret_cast<sockaddr*>(&theirs), &size) != 0) return false;
  const auto put = [](const sockaddr_storage& from, __be32* address, __be16& port) {
    if (from.ss_family == AF_INET) {
      const auto& four = reinterpret_cast<const sockaddr_in&>(from);
      std::memcpy(address, &four.sin_addr, sizeof four.sin_addr);
      port = four.sin_port;
    } else {
      const auto& six = reinterpret_cast<const sockaddr_in6&>(from);
      std::memcpy(address, &six.sin6_addr, sizeof six.sin6_addr);
      port = six.sin6_port;
    }
  };
  put(theirs, ask.id.idiag_src, ask.id.idiag_sport);
  put(ours, ask.id.idiag_dst, ask.id.idiag_dport);
  ask.sdiag_family = static_cast<__u8>(ours.ss_family);
  return ours.ss_family == AF_INET || ours.ss_family == AF_INET6;
}

}  // namespace

std::optional<uid_t> owner_of_peer(int socket) {
  Request request;
  if (!fill(socket, request.ask)) return std::nullopt;
  const FileDescriptor netlink(::socket(AF_NETLINK, SOCK_DGRAM | SOCK_CLOEXEC, NETLINK_SOCK_DIAG));
  if (netlink.get() < 0) return std::nullopt;
  request.header.nlmsg_len = sizeof request;
  request.header.nlmsg_type = SOCK_DIAG_BY_FAMILY;
  request.header.nlmsg_flags = NLM_F_REQUEST;
  request.ask.sdiag_protocol = IPPROTO_TCP;
  request.ask.idiag_states = ~0U;
  request.ask.id.idiag_cookie[0] = INET_DIAG_NOCOOKIE;
  request.ask.id.idiag_cookie[1] = INET_DIAG_NOCOOKIE;
  const timeval patience{0, 100'000};  // the kernel answers at once, or never
  (void)::setsockopt(netlink.get(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  if (::send(netlink.get(), &request, sizeof request, 0) != static_cast<ssize_t>(sizeof request)) return std::nullopt;
  alignas(nlmsghdr) std::array<char, 1024> bytes{};
  const ssize_t got = ::recv(netlink.get(), bytes.data(), bytes.size(), 0);
  constexpr std::size_t kLeast = NLMSG_HDRLEN + sizeof(inet_diag_msg);
  if (got < static_cast<ssize_t>(kLeast)) return std::nullopt;
  nlmsghdr header{};
  inet_diag_msg message{};
  std::memcpy(&header, bytes.data(), sizeof header);
  std::memcpy(&message, bytes.data() + NLMSG_HDRLEN, sizeof message);
  if (header.nlmsg_type != SOCK_DIAG_BY_FAMILY || message.idiag_inode == 0) return std::nullopt;
  return message.idiag_uid;
}

}  // namespace footlight::app
