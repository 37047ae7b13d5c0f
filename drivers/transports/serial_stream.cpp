// SPDX-License-Identifier: Apache-2.0
#include "drivers/transports/serial_stream.hpp"

#include <cstddef>
#include <utility>

#include "core/check.hpp"

namespace footlight::drivers {

SerialStream::SerialStream(std::unique_ptr<SerialDevice> device, OpenSerialDevice reopen, SerialSettings settings)
    : device_(std::move(device)), reopen_(std::move(reopen)), settings_(std::move(settings)) {
  FL_CHECK(settings_.bits_per_second > 0);
}

SendStatus SerialStream::write(std::span<const std::uint8_t> bytes) {
  if (!device_) {
    auto device = reopen_();
    if (!device) {
      trouble_ = device.error().message;
      return SendStatus::down;
    }
    device_ = std::move(device).value();
    trouble_.clear();
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

void SerialStream::push_unsent() {
  if (!device_ || unsent_.empty()) return;
  const auto taken = device_->write_some(unsent_);
  if (!taken) return lose_device();
  unsent_.erase(unsent_.begin(), unsent_.begin() + static_cast<std::ptrdiff_t>(*taken));
}

void SerialStream::lose_device() {
  device_.reset();
  unsent_.clear();
  trouble_ = "unplugged";
}

Result<std::unique_ptr<ByteStream>> open_serial(const std::string& place, const SerialSettings& settings) {
  OpenSerialDevice open = [place, settings] { return open_serial_device(place, settings); };
  auto device = open();
  if (!device) return device.error();
  return std::unique_ptr<ByteStream>(
      std::make_unique<SerialStream>(std::move(device).value(), std::move(open), settings));
}

}  // namespace footlight::drivers
