// SPDX-License-Identifier: Apache-2.0
#include "tests/hardware/slcan_adapter.hpp"

#include <array>
#include <cstdlib>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/sockios.h>
#include <linux/tty.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include "tests/hardware/guest.hpp"

namespace footlight::hardware {

SlcanAdapter::SlcanAdapter() : adapter_(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {
  EXPECT_EQ(::grantpt(adapter_.get()), 0);
  EXPECT_EQ(::unlockpt(adapter_.get()), 0);
  terminal_ = FileDescriptor(::open(::ptsname(adapter_.get()), O_RDWR | O_NOCTTY | O_CLOEXEC));
  struct termios raw {};
  EXPECT_EQ(::tcgetattr(terminal_.get(), &raw), 0);
  ::cfmakeraw(&raw);
  EXPECT_EQ(::tcsetattr(terminal_.get(), TCSANOW, &raw), 0);
  const int discipline = N_SLCAN;
  EXPECT_EQ(::ioctl(terminal_.get(), TIOCSETD, &discipline), 0);
  std::array<char, IFNAMSIZ> name{};
  EXPECT_EQ(::ioctl(terminal_.get(), SIOCGIFNAME, name.data()), 0);
  interface_ = name.data();
  run("ip link set " + interface_ + " up");
}

SlcanAdapter::~SlcanAdapter() { hang_up(); }

void SlcanAdapter::say(const std::string& line) {
  const std::string bytes = line + "\r";
  EXPECT_EQ(::write(adapter_.get(), bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
}

std::vector<std::string> SlcanAdapter::read() {
  std::array<char, 4096> buffer{};
  for (ssize_t size = 0; (size = ::read(adapter_.get(), buffer.data(), buffer.size())) > 0;) {
    partial_.append(buffer.data(), static_cast<std::size_t>(size));
  }
  std::vector<std::string> lines;
  for (std::size_t end = 0; (end = partial_.find('\r')) != std::string::npos; partial_.erase(0, end + 1)) {
    lines.push_back(partial_.substr(0, end));
  }
  return lines;
}

void SlcanAdapter::hang_up() {
  terminal_ = FileDescriptor(-1);
  adapter_ = FileDescriptor(-1);
}

}  // namespace footlight::hardware
