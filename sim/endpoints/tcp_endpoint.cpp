// SPDX-License-Identifier: Apache-2.0
#include "sim/endpoints/tcp_endpoint.hpp"

#include <array>
#include <cerrno>
#include <span>
#include <system_error>
#include <utility>

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

namespace footlight::sim {
namespace {

constexpr std::size_t kMbapToLength = 6;  ///< transaction, protocol, length
constexpr std::size_t kLongestPdu = 254;  ///< unit id included (Modbus Messaging on TCP/IP V1.0b, 3.1)
constexpr int kBacklog = 8;

Error failed(int port, const std::string& what) {
  const int error = errno;
  return input_error("port 127.0.0.1:" + std::to_string(port) + ": " + what + ": " +
                     std::generic_category().message(error) + " (--ports-from gives the first of the ports)");
}

}  // namespace

Result<std::unique_ptr<TcpEndpoint>> TcpEndpoint::open(int port, ModbusLine& bus) {
  FileDescriptor listener(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (listener.get() < 0) return failed(port, "no socket");
  const int on = 1;  // a port that has just been closed may be taken again
  ::setsockopt(listener.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  struct sockaddr_in address {};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  socklen_t size = sizeof address;
  if (::bind(listener.get(), reinterpret_cast<struct sockaddr*>(&address), size) != 0 ||
      ::listen(listener.get(), kBacklog) != 0 ||
      ::getsockname(listener.get(), reinterpret_cast<struct sockaddr*>(&address), &size) != 0) {
    return failed(port, "not opened");
  }
  return std::unique_ptr<TcpEndpoint>(new TcpEndpoint(std::move(listener), ntohs(address.sin_port), bus));
}

void TcpEndpoint::add_handles(std::vector<pollfd>& files) const {
  files.push_back({listener_.get(), POLLIN, 0});
  for (const auto& [number, client] : clients_) files.push_back({client.socket.get(), POLLIN, 0});
}

Instant TcpEndpoint::step(Instant /*now*/) {
  welcome();
  for (auto client = clients_.begin(); client != clients_.end();) {
    client = listen_to(client->first, client->second) ? std::next(client) : clients_.erase(client);
  }
  int number = 0;
  std::vector<std::uint8_t> said;
  while (bus_.hear(number, said)) {
    const auto client = clients_.find(number);
    if (client == clients_.end()) continue;
    // An answer has at most 260 bytes: a client that leaves no room for it does not read.
    if (::send(client->second.socket.get(), said.data(), said.size(), MSG_NOSIGNAL | MSG_DONTWAIT) !=
        static_cast<ssize_t>(said.size())) {
      clients_.erase(client);
    }
  }
  return kNever;
}

void TcpEndpoint::welcome() {
  while (true) {
    FileDescriptor socket(::accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (socket.get() < 0) return;
    if (clients_.size() == kMostClients) continue;  // closed at once
    const int on = 1;
    ::setsockopt(socket.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    clients_.emplace(next_client_++, Client{std::move(socket), {}});
  }
}

bool TcpEndpoint::listen_to(int number, Client& client) {
  std::array<std::uint8_t, 1024> buffer{};
  ssize_t count = 0;
  while ((count = ::read(client.socket.get(), buffer.data(), buffer.size())) > 0) {
    used_ = true;
    client.heard.insert(client.heard.end(), buffer.begin(), buffer.begin() + count);
    while (client.heard.size() >= kMbapToLength) {
      const std::size_t length = (std::size_t{client.heard[4]} << 8U) | client.heard[5];
      if (client.heard[2] != 0 || client.heard[3] != 0 || length < 2 || length > kLongestPdu) return false;
      const std::size_t size = kMbapToLength + length;
      if (client.heard.size() < size) break;
      bus_.say(number, std::span(client.heard).first(size));
      client.heard.erase(client.heard.begin(), client.heard.begin() + static_cast<std::ptrdiff_t>(size));
    }
  }
  return count < 0 && (errno == EAGAIN || errno == EINTR);
}

}  // namespace footlight::sim
