// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <termios.h>
#include <unistd.h>

#include "core/file_descriptor.hpp"

namespace footlight::drivers {

/// A pair of the kernel's pseudo-terminals: `path` is what a program opens as its serial port, the other end is ours.
class PseudoTerminal {
 public:
  PseudoTerminal() {
    int near = -1;
    int far = -1;
    std::array<char, 128> name{};
    EXPECT_EQ(::openpty(&near, &far, name.data(), nullptr, nullptr), 0);
    near_ = FileDescriptor(near);
    keep_ = FileDescriptor(far);
    path_ = name.data();
    struct termios settings {};
    EXPECT_EQ(::tcgetattr(far, &settings), 0);
    ::cfmakeraw(&settings);
    EXPECT_EQ(::tcsetattr(far, TCSANOW, &settings), 0);
  }

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] int near() const { return near_.get(); }

  void write(std::span<const std::uint8_t> bytes) const {
    EXPECT_EQ(::write(near_.get(), bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }

  /// Waits for exactly so many bytes; fewer when none comes for two seconds.
  [[nodiscard]] std::vector<std::uint8_t> read(std::size_t count) const {
    std::vector<std::uint8_t> bytes;
    while (bytes.size() < count) {
      pollfd file{near_.get(), POLLIN, 0};
      if (::poll(&file, 1, 2'000) <= 0) break;
      std::array<std::uint8_t, 256> buffer{};
      const ssize_t got = ::read(near_.get(), buffer.data(), std::min(buffer.size(), count - bytes.size()));
      if (got <= 0) break;
      bytes.insert(bytes.end(), buffer.begin(), buffer.begin() + got);
    }
    return bytes;
  }

  /// True when nothing has arrived.
  [[nodiscard]] bool silent() const {
    pollfd file{near_.get(), POLLIN, 0};
    return ::poll(&file, 1, 0) == 0;
  }

  /// As if the cable were pulled.
  void unplug() {
    near_ = FileDescriptor();
    keep_ = FileDescriptor();
  }

 private:
  FileDescriptor near_;
  FileDescriptor keep_;  ///< without it the pair hangs up whenever the program closes its end
  std::string path_;
};

}  // namespace footlight::drivers
