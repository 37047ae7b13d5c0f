// SPDX-License-Identifier: Apache-2.0
#include "drivers/transports/serial_stream.hpp"

#include <cerrno>
#include <cstddef>
#include <system_error>
#include <utility>

#include <sys/stat.h>
#include <sys/sysmacros.h>

#include "core/check.hpp"

namespace footlight::drivers {
namespace {

constexpr int kBitsPerCharacter = 10;

/// Unix98 slaves have the majors 136 to 143 (Linux, Documentation/admin-guide/devices.txt).
bool is_pseudo_terminal(const struct stat& status) {
  return major(status.st_rdev) >= 136 && major(status.st_rdev) <= 143;
}

}  // namespace

SerialStream::SerialStream(std::unique_ptr<SerialDevice> device, OpenSerialDevice reopen, int bits_per_second)
    : device_(std::move(device)), reopen_(std::move(reopen)), bits_per_second_(bits_per_second) {
  FL_CHECK(bits_per_second_ > 0);
}

SendStatus SerialStream::write(std::span<const std::uint8_t> bytes) {
  if (!device_) {
    auto device = reopen_();
    if (!device) return SendStatus::down;
    device_ = std::move(device).value();
  }
  push_unsent();
  if (!device_) return SendStatus::down;
  if (!unsent_.empty()) return SendStatus::busy;
  const auto taken = device_->write_some(bytes);
  if (!taken) {
    lose_device();
    return SendStatus::down;
  }
  if (*taken == 0 && !bytes.empty()) return SendStatus::busy;
  unsent_.assign(bytes.begin() + static_cast<std::ptrdiff_t>(*taken), bytes.end());
  return SendStatus::accepted;
}

std::size_t SerialStream::read(std::span<std::uint8_t> buffer) {
  push_unsent();
  if (!device_) return 0;
  const auto count = device_->read_some(buffer);
  if (!count) lose_device();
  return count.value_or(0);
}

Duration SerialStream::wire_time(std::size_t bytes) const {
  const auto bits = static_cast<Duration::rep>(bytes) * kBitsPerCharacter;
  return Duration((bits * 1'000'000'000 + bits_per_second_ - 1) / bits_per_second_);
}

void SerialStream::push_unsent() {
  if (!device_ || unsent_.empty()) return;
  const auto taken = device_->write_some(unsent_);
  if (!taken) return lose_device();
  unsent_.erase(unsent_.begin(), unsent_.begin() + static_cast<std::ptrdiff_t>(*taken));
}

void SerialStream::lose_device() {
  device_.reset();
  unsent_.clear();
}

Result<std::unique_ptr<ByteStream>> open_serial(const std::string& path, int bits_per_second) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) {
    return device_error("serial port \"" + path + "\": " + std::generic_category().message(errno) +
                        " (a port as listed in /dev/serial/by-id)");
  }
  if (!S_ISCHR(status.st_mode)) {
    return device_error("serial port \"" + path + "\": not a serial port (a port as listed in /dev/serial/by-id)");
  }
  OpenSerialDevice open;
  if (is_pseudo_terminal(status)) {
    open = [path] { return open_terminal_device(path); };
  } else {
    open = [path, bits_per_second] { return open_serial_port_device(path, bits_per_second); };
  }
  auto device = open();
  if (!device) return device.error();
  return std::unique_ptr<ByteStream>(
      std::make_unique<SerialStream>(std::move(device).value(), std::move(open), bits_per_second));
}

}  // namespace footlight::drivers
