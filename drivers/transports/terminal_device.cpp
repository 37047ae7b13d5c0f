// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include "core/file_descriptor.hpp"
#include "drivers/transports/serial_device.hpp"

namespace footlight::drivers {
namespace {

class TerminalDevice final : public SerialDevice {
 public:
  explicit TerminalDevice(FileDescriptor file) : file_(std::move(file)) {}

  std::optional<std::size_t> write_some(std::span<const std::uint8_t> bytes) override {
    return outcome(::write(file_.get(), bytes.data(), bytes.size()));
  }
  std::optional<std::size_t> read_some(std::span<std::uint8_t> buffer) override {
    const ssize_t count = ::read(file_.get(), buffer.data(), buffer.size());
    // A terminal that has been hung up has an end and is readable without end.
    if (count == 0 && !buffer.empty()) return std::nullopt;
    return outcome(count);
  }
  [[nodiscard]] int poll_handle() const override { return file_.get(); }

 private:
  static std::optional<std::size_t> outcome(ssize_t count) {
    if (count >= 0) return static_cast<std::size_t>(count);
    if (errno == EAGAIN || errno == EINTR) return 0;
    return std::nullopt;  // EIO: the other end has been closed
  }

  FileDescriptor file_;
};

Error failed(const std::string& path) {
  return device_error("terminal \"" + path + "\": " + std::generic_category().message(errno));
}

}  // namespace

Result<std::unique_ptr<SerialDevice>> open_terminal_device(const std::string& path) {
  FileDescriptor file(::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (file.get() < 0) return failed(path);
  struct termios settings {};
  if (::tcgetattr(file.get(), &settings) != 0) return failed(path);
  ::cfmakeraw(&settings);
  if (::tcsetattr(file.get(), TCSANOW, &settings) != 0) return failed(path);
  if (::ioctl(file.get(), TIOCEXCL) != 0) return failed(path);  // a second controller is refused
  return std::unique_ptr<SerialDevice>(std::make_unique<TerminalDevice>(std::move(file)));
}

}  // namespace footlight::drivers
