// SPDX-License-Identifier: Apache-2.0
#include "sim/endpoints/pseudo_terminal.hpp"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

namespace footlight::sim {
namespace {

Error failed(const std::filesystem::path& link, const std::string& what, int error) {
  return input_error("serial port \"" + link.string() + "\": " + what + ": " + std::generic_category().message(error) +
                     " (--dir names a folder of your own for these links)");
}

}  // namespace

Result<PseudoTerminal> PseudoTerminal::open(std::filesystem::path link) {
  PseudoTerminal terminal(std::move(link));
  std::error_code error;
  const auto there = std::filesystem::symlink_status(terminal.link_, error);
  if (std::filesystem::exists(there) && !std::filesystem::is_symlink(there)) {
    return failed(std::exchange(terminal.link_, {}), "something else has this name", EEXIST);
  }
  if (auto renewed = terminal.renew(); !renewed) return renewed.error();
  return terminal;
}

PseudoTerminal::~PseudoTerminal() {
  if (file_.get() < 0 || link_.empty()) return;
  std::error_code ignored;
  std::filesystem::remove(link_, ignored);
}

Status<> PseudoTerminal::renew() {
  FileDescriptor file(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  std::array<char, 64> name{};
  if (file.get() < 0 || ::grantpt(file.get()) != 0 || ::unlockpt(file.get()) != 0 ||
      ::ptsname_r(file.get(), name.data(), name.size()) != 0) {
    return failed(link_, "no pseudo-terminal", errno);
  }
  struct termios settings {};
  if (::tcgetattr(file.get(), &settings) != 0) return failed(link_, "no settings", errno);
  ::cfmakeraw(&settings);  // Linux applies to the other end what is set at this one
  if (::tcsetattr(file.get(), TCSANOW, &settings) != 0) return failed(link_, "no settings", errno);
  const std::string fresh = link_.string() + ".new";
  ::unlink(fresh.c_str());
  if (::symlink(name.data(), fresh.c_str()) != 0 || ::rename(fresh.c_str(), link_.c_str()) != 0) {
    return failed(link_, "no link", errno);
  }
  file_ = std::move(file);
  return Done{};
}

bool PseudoTerminal::hung_up() const {
  pollfd file{file_.get(), POLLIN, 0};
  return ::poll(&file, 1, 0) > 0 && (file.revents & (POLLHUP | POLLIN)) == POLLHUP;
}

std::size_t PseudoTerminal::read(std::span<std::uint8_t> buffer) {
  const ssize_t count = ::read(file_.get(), buffer.data(), buffer.size());
  if (count > 0) return static_cast<std::size_t>(count);
  // Somebody may have opened it again meanwhile, and keeps it then.
  if (hung_up()) (void)renew();  // where it fails, the old one serves on and is tried again
  return 0;
}

void PseudoTerminal::write(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(file_.get(), bytes.data(), bytes.size());
    if (count <= 0) return;
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
}

}  // namespace footlight::sim
