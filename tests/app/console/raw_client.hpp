// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/file_descriptor.hpp"

namespace footlight::tests {

/// A client of the console that may send whatever it likes. Nothing waits longer than ten seconds.
class RawClient {
 public:
  explicit RawClient(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)), port_(port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }

  /// @return false when the other side takes no more
  bool send(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t put = ::send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (put <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(put));
    }
    return true;
  }
  /// Takes what comes until `enough` says so, or the other side ends it. @return false when it has ended
  template <class Enough>
  bool read_until(Enough enough, int at_most_ms = 10'000) {
    std::array<char, 65536> bytes{};
    while (!enough(got_)) {
      pollfd file{socket_.get(), POLLIN, 0};
      if (::poll(&file, 1, at_most_ms) <= 0) {
        timed_out_ = true;
        return false;
      }
      const ssize_t count = ::recv(socket_.get(), bytes.data(), bytes.size(), 0);
      if (count <= 0) return false;
      got_.append(bytes.data(), static_cast<std::size_t>(count));
    }
    return true;
  }
  /// All that comes until the other side ends it.
  std::string rest() {
    (void)read_until([](const std::string&) { return false; });
    return std::exchange(got_, {});
  }
  /// One response, with its body.
  std::string response() {
    const auto whole = [](const std::string& text) {
      const std::size_t end = text.find("\r\n\r\n");
      if (end == std::string::npos) return false;
      const std::size_t length = text.find("Content-Length: ");
      return length == std::string::npos || length > end ||
             text.size() >= end + 4 + std::stoul(text.substr(length + 16));
    };
    (void)read_until(whole);
    return std::exchange(got_, {});
  }
  [[nodiscard]] bool timed_out() const { return timed_out_; }

  [[nodiscard]] std::string host() const { return "127.0.0.1:" + std::to_string(port_); }
  [[nodiscard]] std::string get(const std::string& target, const std::string& more = "") const {
    return "GET " + target + " HTTP/1.1\r\nHost: " + host() + "\r\n" + more + "\r\n";
  }
  [[nodiscard]] std::string upgrade(const std::string& more = "") const {
    return "GET /ws HTTP/1.1\r\nHost: " + host() + "\r\nOrigin: http://" + host() +
           "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: "
           "dGhlIHNhbXBsZSBub25jZQ==\r\n" +
           more + "\r\n";
  }

  /// A frame as a client has to make them (RFC 6455, 5.2): masked, here with zeros.
  [[nodiscard]] static std::string frame(std::string_view text, char first = '\x81') {
    std::string out{first};
    if (text.size() < 126) {
      out += static_cast<char>(0x80U | text.size());
    } else {
      out += {static_cast<char>(0x80U | 126U), static_cast<char>(text.size() >> 8U), static_cast<char>(text.size())};
    }
    return out + std::string(4, '\0') + std::string(text);
  }
  /// Becomes a WebSocket. @return whether it was let in
  bool open() {
    send(upgrade());
    (void)read_until([](const std::string& text) { return text.find("\r\n\r\n") != std::string::npos; });
    const bool in = got_.starts_with("HTTP/1.1 101");
    if (in) got_.erase(0, got_.find("\r\n\r\n") + 4);
    return in;
  }
  bool say(std::string_view text) const { return send(frame(text)); }

  struct Frame {
    int kind = -1;  ///< opcode; -1: the connection has ended
    std::string payload;
    /// Of a close frame.
    [[nodiscard]] int code() const {
      return kind != 8 || payload.size() < 2
                 ? 0
                 : static_cast<unsigned char>(payload[0]) * 256 + static_cast<unsigned char>(payload[1]);
    }
  };
  Frame next() {
    std::size_t header = 0;
    std::size_t length = 0;
    const auto whole = [&](const std::string& bytes) {
      const auto at = [&](std::size_t i) { return static_cast<std::size_t>(static_cast<unsigned char>(bytes[i])); };
      if (bytes.size() < 2) return false;
      header = at(1) < 126 ? 2 : at(1) == 126 ? 4 : 10;
      if (bytes.size() < header) return false;
      length = at(1) < 126 ? at(1) : 0;
      for (std::size_t i = 2; i < header; ++i) length = length << 8U | at(i);
      return bytes.size() >= header + length;
    };
    if (!read_until(whole)) return {};
    Frame out{got_[0] & 15, got_.substr(header, length)};
    got_.erase(0, header + length);
    return out;
  }
  /// The next text that has `word`, all before it are left out; empty when the connection ends first.
  std::string heard(const std::string& word) {
    for (Frame frame = next(); frame.kind >= 0 && frame.kind != 8; frame = next()) {
      if (frame.kind == 1 && frame.payload.find(word) != std::string::npos) return frame.payload;
    }
    return "";
  }
  /// The code with which the other side ends it; 0: without one.
  int farewell() {
    for (Frame frame = next(); frame.kind >= 0; frame = next()) {
      if (frame.kind == 8) return frame.code();
    }
    return 0;
  }

 private:
  FileDescriptor socket_;
  std::uint16_t port_;
  std::string got_;
  bool timed_out_ = false;
};

}  // namespace footlight::tests
